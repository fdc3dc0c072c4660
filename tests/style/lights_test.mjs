// The judge of questions about lights, judged by made-up files.
import assert from "node:assert/strict";
import test from "node:test";

import { question_in, violations } from "./lights.mjs";

test("every form of the question is found, in C++ and GLSL", () => {
  for (const source of [
    "if (light.kind == LightKind::spot) f();",
    "bool b = ExtentKind::none != extent.kind;",
    "switch (k) {\n case penumbra::LightKind::point: break;\n}",
    "if (shape == LightShape::ball) f();",
    "bool b = int(light.position.w) == 1;",
    "if (kind == light_kind_spot) f();",
    "return kind == shader::extent_kind_disc;",
    "bool square = int(light.extent.x) == 3;",
    "if (is_directional()) f();",
    "if (light.center.w == 0.0) f();",
    "return extent_kind() > 0;",
  ]) assert.ok(question_in(`\n${source}`) >= 2, source);
  assert.equal(question_in("int a;\n\nif (light.kind != LightKind::spot) f();\n"), 3);
});

test("tables, literals, texts, comments and the light's own answers are silent", () => {
  for (const source of [
    "light.kind = LightKind::directional;",
    'table = {{"spot", LightKind::spot}, {"point", LightKind::point}};',
    "enum class LightKind { spot = shader::light_kind_spot };",
    "const int light_kind_spot = 0;",
    "// where kind == LightKind::spot\nint a;",
    'fail("light.kind == LightKind::spot");',
    "for (LightKind kind : layout.serves) f(kind);",
    "offset = vec3(center) - center.w * point;",
    "if (is_at_infinity(light) || has_extent(light)) f();",
    "if (field.kind == FieldKind::list) f();",
  ]) assert.equal(question_in(source), undefined, source);
});

test("five files may ask, and tests; of six each is named with its line", () => {
  const asks = "\nif (light.kind == LightKind::spot) f();";
  const files = Object.fromEntries(["a", "b", "c", "d", "e", "tests/t"].map((name) => [`${name}.cpp`, asks]));
  assert.deepEqual(violations(files), []);
  assert.deepEqual(violations({ ...files, "f.glsl": "\nreturn is_spot();" }).slice(1),
    ["  a.cpp:2", "  b.cpp:2", "  c.cpp:2", "  d.cpp:2", "  e.cpp:2", "  f.glsl:2"]);
});
