-- What was measured of a frozen picture, as JSON by name (study/measures.h): cost and errors of the
-- render that it was taken from. NULL until that was measured.
ALTER TABLE pictures ADD COLUMN measures TEXT;
