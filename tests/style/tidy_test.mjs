// What clang-tidy is asked, and that it is heard.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import test from "node:test";

import { check, reading_flags, targets_of, words_of } from "./tidy.mjs";

test("words are those that a shell reads", () => {
  assert.deepEqual(words_of(String.raw`c++ -DA=\"1.0\" '-DB="x y"' "-DC=\"z\"" file.cpp`),
    ["c++", '-DA="1.0"', '-DB="x y"', '-DC="z"', "file.cpp"]);
});

test("of a command stays what says how the code is to be read", () => {
  assert.deepEqual(reading_flags("/usr/bin/c++ -DX=1 -I/a -isystem /b -O2 -Wall -std=c++20 -include /p.hxx -o o -c f.cpp"),
    ["-DX=1", "-I/a", "-isystem/b", "-std=c++20"]);
});

test("a target is all of its files; tests and measurements are none", () => {
  const entry = (folder, name, file, more = "") => ({ file, command: `c++ -I/a ${more} -o ${folder}CMakeFiles/${name}.dir/x.o -c ${file}` });
  assert.deepEqual(targets_of([entry("study/", "study", "/b.cpp"), entry("study/", "study", "/a.cpp", "-DA"),
    entry("tests/study/", "t", "/t.cpp"), entry("bench/", "b", "/m.cpp"), entry("", "main", "/m.cpp")]), [
    { name: "study", files: ["/a.cpp", "/b.cpp"], flags: ["-I/a", "-DA"] },
    { name: "main", files: ["/m.cpp"], flags: ["-I/a"] },
  ]);
});

test("a name against the rules is found in a source and in its header, and nothing in what keeps them", async () => {
  const folder = mkdtempSync(path.join(tmpdir(), "tidy-"));
  const write = (name, text) => writeFileSync(path.join(folder, name), text);
  const said = () => check({ name: "all", files: [path.join(folder, "a.cpp")], flags: ["-std=c++20"] }, folder, `^${folder}/`);
  write("a.h", "#pragma once\nstruct Light { int light_points; };\n");
  write("a.cpp", '#include "a.h"\nnamespace n { int points_of(const Light& light) { return light.light_points; } }\n');
  assert.equal(await said(), "");
  write("a.h", "#pragma once\nstruct light { int lightPoints; };\n");
  write("a.cpp", '#include "a.h"\nnamespace n { int pointsOf(const light& Light) { return Light.lightPoints; } }\n');
  const found = [...(await said()).matchAll(/'(\w+)' \[readability-identifier-naming/g)].map(([, name]) => name);
  assert.deepEqual(found.sort(), ["Light", "light", "lightPoints", "pointsOf"]);
  rmSync(folder, { recursive: true });
});
