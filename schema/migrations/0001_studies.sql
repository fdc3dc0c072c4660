-- Studies by version: a document that changes after publication becomes the draft of a new version.
CREATE TABLE studies (
  study TEXT NOT NULL,
  version INTEGER NOT NULL,
  status TEXT NOT NULL CHECK (status IN ('draft', 'publishing', 'open', 'closed')),
  document TEXT NOT NULL,
  hash TEXT,                                  -- set when frozen
  seed INTEGER NOT NULL,                      -- of the order of pages and pictures
  pictures_done INTEGER NOT NULL DEFAULT 0,
  pictures_total INTEGER NOT NULL DEFAULT 0,
  error TEXT,                                 -- JSON, why the last publication failed
  created_at TEXT NOT NULL,
  opened_at TEXT,
  closed_at TEXT,
  PRIMARY KEY (study, version)
);
CREATE UNIQUE INDEX studies_one_open ON studies (study) WHERE status = 'open';
CREATE UNIQUE INDEX studies_one_draft ON studies (study) WHERE status IN ('draft', 'publishing');

-- Frozen pictures of a version, by the render request of the study; files by content.
CREATE TABLE pictures (
  study TEXT NOT NULL,
  version INTEGER NOT NULL,
  request TEXT NOT NULL,                      -- SHA-256 of the request's JSON
  render TEXT NOT NULL,                       -- id of the render
  digest TEXT NOT NULL,                       -- SHA-256 of the PNG, its file's name
  PRIMARY KEY (study, version, request),
  FOREIGN KEY (study, version) REFERENCES studies (study, version) ON DELETE CASCADE
);
