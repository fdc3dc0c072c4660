// The judge of comments' words, judged by made-up comments.
import assert from "node:assert/strict";
import test from "node:test";

import { comments_of, unplain } from "./words.mjs";

test("comments are read, texts and code are not", () => {
  const source = 'int a;  ///< first\nauto b = "// no comment"; // second\n// third\n// goes on\n\n/* fourth\n * too */\nif (x) y(); else z();\n';
  assert.deepEqual(comments_of(source), [
    { line: 1, text: "first" }, { line: 2, text: "second third goes on" }, { line: 6, text: "fourth too" }]);
});

test("each word is found, over the end of a line too, and named with its line", () => {
  assert.deepEqual(unplain("a.h", "\n// A texel stands\n// for many.\nint a;  // Nobody reads it, else it fails.\n// It runs and answers the count.\n// Nought.\n"), [
    'a.h:2: "stands for" in a comment; write means, replaces, represents, or the verb itself',
    'a.h:4: "Nobody" in a comment; write none, no one, or the passive',
    'a.h:4: "Nought" in a comment; write zero',
    'a.h:4: ", else" in a comment; write otherwise',
    'a.h:4: "answers the " in a comment; write returns',
  ]);
});

test("texts that the program shows are read too, those of tests and pages are not", () => {
  const source = 'fail("a name, which nobody bound");\nf("whatever else");\n';
  assert.deepEqual(unplain("a.cpp", source), ['a.cpp:1: "nobody" in a text; write none, no one, or the passive']);
  for (const file of ["tests/a.cpp", "web/a.js"]) assert.deepEqual(unplain(file, source), []);
});

test("places that things stand at are silent, states are not", () => {
  assert.deepEqual(unplain("a.h", "// The lamp stands on a table, beside which a chair stands.\n"), []);
  assert.deepEqual(unplain("a.h", "// The name as it stands.\n"), ['a.h:1: "as it stands" in a comment; write as it is, or as written']);
});

test("the same words in other meanings are silent", () => {
  assert.deepEqual(unplain("a.cpp", "// Nothing else changes; answers of people stand in the table, and everything else stays.\n"), []);
});
