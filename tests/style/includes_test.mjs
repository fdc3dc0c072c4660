// The judge of includes, judged by made-up trees.
import assert from "node:assert/strict";
import test from "node:test";

import { rooms_of, unnamed_folders, violations } from "./includes.mjs";

const table = `
| folder | what it knows | what it may use |
|---|---|---|
| \`low/\` | words | nothing of ours |
| \`low/deep/\` \`low/api.h\` | things | \`low/\` |
| \`high/\` | all below | \`low/*\` |
| \`tests/\` | cases | everything |
`;
const rooms = rooms_of(table);

test("what the table allows is silent", () => {
  const files = {
    "high/a.cpp": '#include "low/deep/b.h"\n#include "low/api.h"\n#include "high/a.h"\n',
    "low/deep/b.h": '#include <vector>\n#include "low/word.h"\n',
    "tests/a.cpp": '#include "high/a.h"\n',
  };
  assert.deepEqual(violations(rooms, files), []);
});

test("an include upward is named with its line", () => {
  const found = violations(rooms, { "low/word.h": '\n#include "low/api.h"\n' });
  assert.deepEqual(found, ["low/word.h:2: low/ may not use low/api.h"]);
});

test("a folder without a row, and a row for a folder that is not there, are refused", () => {
  assert.deepEqual(violations(rooms, { "new/a.cpp": "" }), ["new/a.cpp: no row of the table has it"]);
  const wrong = rooms_of(table.replace("`low/*`", "`lower/`"));
  assert.deepEqual(violations(wrong, {}), ["high/ may use lower/, which has no row"]);
});

test("a folder of no code needs a row as well", () => {
  assert.deepEqual(unnamed_folders(rooms, ["README.md", ".ci/run", "low/deep/b.h", "tests/a.sh"]), []);
  assert.deepEqual(unnamed_folders(rooms, ["new/a.md", "new/b.md"]), ["new/: no row of the table names it"]);
});

test("rooms that use each other are refused", () => {
  const circle = rooms_of(table.replace("nothing of ours", "`high/`"));
  assert.ok(violations(circle, {}).includes("low/ may use what may use it"));
});
