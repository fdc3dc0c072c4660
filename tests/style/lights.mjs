// How many files ask of which kind a light or its extent is: a new kind is written there and nowhere else.
//   node tests/style/lights.mjs
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const most_files = 5;

const kind = String.raw`(\w+::)*((LightKind|ExtentKind|LightShape)::\w+|(light|extent)_kind_\w+)`;

/// Code that takes one way for one kind and another for the next: a comparison, a case, a predicate, or the
/// number that shaders hold the kind in. A name in a table or a literal that makes a light is none.
const questions = [
  new RegExp(String.raw`[=!]=\s*${kind}`),
  new RegExp(String.raw`\b${kind}\s*[=!]=`),
  new RegExp(String.raw`\bcase\s+${kind}`),
  /\blight(\(\)|->|\.)(source->)?(extent\.)?kind\s*[=!]=/,
  /\bswitch\s*\([^;{]*\bkind\(?\)?\s*\)\s*\{\s*case\s+(\w+::)*(spot|directional|point|sphere|disc|rectangle)\b/,
  /\blight\.(position\.w|extent\.x)\b/,
  /\b(light|extent)_kind\(/,
  /\bcenter\.w\s*([=!<>]=|[<>?])/,
  /\b\w*is_(spot|directional|point|sphere|ball|disc|rectangle|square)(_light)?\(/,
];

/// A source without comments and texts; lines stay where they are.
function code_of(source) {
  return source.replace(/"(?:\\.|[^"\\\n])*"|\/\/[^\n]*|\/\*[^]*?\*\//g, (part) => part.replace(/[^\n]/g, " "));
}

/// Where a file first asks; undefined where it does not.
export function question_in(source) {
  const code = code_of(source);
  const places = questions.map((question) => question.exec(code)?.index).filter((index) => index !== undefined);
  return places.length ? code.slice(0, Math.min(...places)).split("\n").length : undefined;
}

/// What breaks the rule: `files` maps names to texts. Tests ask what they like.
export function violations(files) {
  const asking = Object.entries(files)
    .filter(([name]) => !name.startsWith("tests/"))
    .map(([name, source]) => [name, question_in(source)])
    .filter(([, line]) => line !== undefined);
  if (asking.length <= most_files) return [];
  return [
    `${asking.length} files ask of which kind a light or its extent is; ${most_files} may. Ask light.h or light.glsl.`,
    ...asking.map(([name, line]) => `  ${name}:${line}`),
  ];
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
  const ends = ["h", "cpp", "glsl", "vert", "frag", "geom", "comp"].map((end) => `*.${end}`);
  const names = execFileSync("git", ["ls-files", "--cached", "--others", "--exclude-standard", ...ends], { encoding: "utf8", maxBuffer: 1 << 26 });
  const known = names.split("\n").filter((name) => name && existsSync(name));
  const found = violations(Object.fromEntries(known.map((name) => [name, readFileSync(name, "utf8")])));
  if (found.length) console.error(found.join("\n"));
  process.exitCode = found.length ? 1 : 0;
}
