// Comments in plain words: what an engineer would say aloud.
//   node tests/style/words.mjs
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

/// What is not written, and what is instead.
const rules = [
  [/\bnobody\b/i, "none, no one, or the passive"],
  [/\bwhoever\b/i, "a plain subject"],
  [/\bnought\b/i, "zero"],
  [/\bstands? for\b/i, "means, replaces, represents, or the verb itself"],
  [/[,;(] ?(and )?else\b/i, "otherwise"],
  [/\banswers (what|whether|where|it|the) /i, "returns"],
];

/// Comments of a source file: { line, text }. Lines that follow each other are one comment.
export function comments_of(source) {
  const found = [];
  const parts = /"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|\/\/[^\n]*|\/\*[^]*?\*\//g;
  for (const { 0: part, index } of source.matchAll(parts)) {
    if (!part.startsWith("/")) continue;
    const line = source.slice(0, index).split("\n").length;
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

/// What the comments of a file say in other words than plain ones.
export function unplain(file, source) {
  return comments_of(source).flatMap(({ line, text }) =>
    rules.flatMap(([pattern, plain]) => {
      const said = pattern.exec(text)?.[0];
      return said ? [`${file}:${line}: "${said}" in a comment; write ${plain}`] : [];
    }));
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const files = execFileSync("git", ["ls-files", "*.cpp", "*.h", "*.glsl", "*.vert", "*.frag", "*.geom", "*.comp", "*.js"], { encoding: "utf8" });
  const found = files.split("\n").filter(Boolean).flatMap((file) => unplain(file, readFileSync(file, "utf8")));
  if (found.length) console.error(found.join("\n"));
  process.exitCode = found.length ? 1 : 0;
}
