-- Sweeps by request; what they measured is in the renders' cache, by content.
CREATE TABLE sweeps (
  sweep TEXT NOT NULL PRIMARY KEY,
  request TEXT NOT NULL,
  created_at TEXT NOT NULL
);
