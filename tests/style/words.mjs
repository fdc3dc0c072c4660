// Comments, and texts of the program, in plain words: what an engineer would say aloud.
//   node tests/style/words.mjs
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

/// What is not written anywhere, and what is instead.
const everywhere = [
  [/\bnobody\b/i, "none, no one, or the passive"],
  [/\bwhoever\b/i, "a plain subject"],
  [/\bnought\b/i, "zero"],
];

/// What is not written in comments.
const rules = [
  ...everywhere,
  [/\bstands? in for\b/i, "replaces"],
  [/\bas (it|they) stands?\b/i, "as it is, or as written"],
  [/\bstands? for\b/i, "means, replaces, represents, or the verb itself"],
  [/[,;(] ?(and )?else\b/i, "otherwise"],
  [/\banswers (what|whether|where|it|the) /i, "returns"],
];

const parts = /"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|\/\/[^\n]*|\/\*[^]*?\*\//g;

const line_of = (source, index) => source.slice(0, index).split("\n").length;

/// Comments of a source file: { line, text }. Lines that follow each other are one comment.
export function comments_of(source) {
  const found = [];
  for (const { 0: part, index } of source.matchAll(parts)) {
    if (!part.startsWith("/")) continue;
    const line = line_of(source, index);
    const text = part.replace(/^\/[/*]+<?|\*\/$/g, "").replace(/\n[\s*]*/g, " ").trim();
    const last = found.at(-1);
    if (last?.end === line - 1 && /^[ \t]*$/.test(source.slice(source.lastIndexOf("\n", index) + 1, index))) {
      last.text += ` ${text}`;
      last.end = line;
    } else {
      found.push({ line, end: line + part.split("\n").length - 1, text });
    }
  }
  return found.map(({ line, text }) => ({ line, text }));
}

/// Texts of a C++ file that the program may show; tests show none, and pages have a language of their own.
function texts_of(file, source) {
  if (!/\.(cpp|h)$/.test(file) || file.startsWith("tests/")) return [];
  return [...source.matchAll(parts)]
    .filter(({ 0: part }) => part.startsWith('"'))
    .map(({ 0: text, index }) => ({ line: line_of(source, index), text }));
}

/// What a file says in other words than plain ones.
export function unplain(file, source) {
  const found = (where, said_there, patterns) =>
    said_there.flatMap(({ line, text }) =>
      patterns.flatMap(([pattern, plain]) => {
        const said = pattern.exec(text)?.[0];
        return said ? [`${file}:${line}: "${said}" in a ${where}; write ${plain}`] : [];
      }));
  return [...found("comment", comments_of(source), rules), ...found("text", texts_of(file, source), everywhere)];
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const files = execFileSync("git", ["ls-files", "*.cpp", "*.h", "*.glsl", "*.vert", "*.frag", "*.geom", "*.comp", "*.js"], { encoding: "utf8" });
  const found = files.split("\n").filter(Boolean).flatMap((file) => unplain(file, readFileSync(file, "utf8")));
  if (found.length) console.error(found.join("\n"));
  process.exitCode = found.length ? 1 : 0;
}
