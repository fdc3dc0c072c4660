-- Keyed digests of rows (server/storage/seals.h), so that flipped bytes are seen. The program fills
-- them in when it applies this file.
ALTER TABLE studies ADD COLUMN seal TEXT;
ALTER TABLE pictures ADD COLUMN seal TEXT;
ALTER TABLE participants ADD COLUMN seal TEXT;
ALTER TABLE answers ADD COLUMN seal TEXT;
ALTER TABLE exclusions ADD COLUMN seal TEXT;
ALTER TABLE withdrawals ADD COLUMN seal TEXT;
ALTER TABLE sweeps ADD COLUMN seal TEXT;

-- How far the database has come beside its journal (server/storage/journal.h).
CREATE TABLE ledger (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  commits INTEGER NOT NULL,                   -- that changed sealed rows
  logged INTEGER NOT NULL,                    -- of them, those that the journal had before the last
  unlogged TEXT NOT NULL,                     -- seals of the rows of the others
  seal TEXT
);
INSERT INTO ledger (id, commits, logged, unlogged) VALUES (1, 1, 0, '');

-- The place of the next person is found in indexes, however many have come.
ALTER TABLE withdrawals ADD COLUMN place INTEGER;  -- that became free
CREATE INDEX participants_by_last_seen ON participants (study, version, seen_at, place)
  WHERE holds_place = 1 AND test = 0 AND completed_at IS NULL;
