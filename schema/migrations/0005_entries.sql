-- The value of the link's parameter that names a person, so that somebody enters a study once.
ALTER TABLE participants ADD COLUMN person_id TEXT;
CREATE INDEX participants_by_person ON participants (study, person_id) WHERE test = 0;
