CREATE TABLE participants (
  id INTEGER PRIMARY KEY,
  pseudonym TEXT NOT NULL UNIQUE,             -- the only name in exports
  study TEXT NOT NULL,
  version INTEGER NOT NULL,
  place INTEGER NOT NULL,                     -- in the balanced orders of the version
  holds_place INTEGER NOT NULL,               -- 0 once a dropped place went to somebody else
  test INTEGER NOT NULL,                      -- a researcher's preview, never counted
  token TEXT NOT NULL,
  token_hash TEXT NOT NULL UNIQUE,            -- looked up instead of the token: no timing to learn from
  withdrawal_code TEXT NOT NULL UNIQUE,
  enrolment_id TEXT NOT NULL,
  language TEXT NOT NULL,
  consent_version TEXT NOT NULL,
  parameters TEXT NOT NULL,                   -- JSON, of the link
  details TEXT NOT NULL,                      -- JSON, answers about the person, given at the end
  entered_at TEXT NOT NULL,
  seen_at TEXT NOT NULL,
  completed_at TEXT,
  UNIQUE (study, enrolment_id),
  FOREIGN KEY (study, version) REFERENCES studies (study, version)
);
CREATE UNIQUE INDEX participants_one_per_place ON participants (study, version, place)
  WHERE holds_place = 1 AND test = 0;

-- Every answer ever given; the current one of a page is marked, and only one can be.
CREATE TABLE answers (
  id INTEGER PRIMARY KEY,
  participant INTEGER NOT NULL REFERENCES participants (id) ON DELETE CASCADE,
  page INTEGER NOT NULL,
  answer_id TEXT NOT NULL,
  body TEXT NOT NULL,
  reply TEXT NOT NULL,
  answered_at TEXT NOT NULL,
  is_current INTEGER NOT NULL,
  UNIQUE (participant, answer_id)
);
CREATE UNIQUE INDEX answers_one_current ON answers (participant, page) WHERE is_current = 1;

-- Decisions of researchers about participants; the last one counts, none is deleted.
CREATE TABLE exclusions (
  id INTEGER PRIMARY KEY,
  participant INTEGER NOT NULL REFERENCES participants (id) ON DELETE CASCADE,
  excluded INTEGER NOT NULL,
  reason TEXT NOT NULL,
  decided_at TEXT NOT NULL
);
CREATE INDEX exclusions_by_participant ON exclusions (participant);

-- That somebody left, without who: the person's rows are deleted.
CREATE TABLE withdrawals (
  study TEXT NOT NULL,
  version INTEGER NOT NULL,
  withdrawn_at TEXT NOT NULL
);
