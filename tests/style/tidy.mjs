// clang-tidy over every library and program, by .clang-tidy. A target is read as one file, so that headers
// are read once; what was clean and has not changed since is not read again.
//   node tests/style/tidy.mjs [BUILD]      BUILD: a configured build folder; build unless named
import { execFile, execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { availableParallelism } from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";

/// Words of a command as a shell reads them.
export function words_of(command) {
  const words = [];
  for (const [, word] of command.matchAll(/((?:\\.|"(?:\\.|[^"\\])*"|'[^']*'|[^\s"'\\])+)/g))
    words.push(word.replace(/\\(.)|"((?:\\.|[^"\\])*)"|'([^']*)'/g, (all, escaped, double, single) =>
      escaped ?? single ?? double.replace(/\\(.)/g, "$1")));
  return words;
}

/// What of a compiler's command says how the code is to be read.
export function reading_flags(command) {
  const flags = [];
  const words = words_of(command);
  for (let at = 0; at < words.length; ++at) {
    if (words[at] === "-isystem" || words[at] === "-I") flags.push(`${words[at]}${words[++at]}`);
    else if (/^-(I|D|std=|isystem)/.test(words[at])) flags.push(words[at]);
  }
  return flags;
}

/// Targets of a compilation database: name, sources and flags. Programs of tests and measurements are left
/// out: nothing else sees what they define.
export function targets_of(commands) {
  const targets = new Map();
  for (const { file, command } of commands) {
    const [, folder, name] = /-o (\S*?)CMakeFiles\/([^/]+)\.dir\//.exec(command) ?? [];
    if (!name || /^(tests|bench)\//.test(folder)) continue;
    if (!targets.has(name)) targets.set(name, { name, files: [], flags: [] });
    const target = targets.get(name);
    target.files.push(file);
    target.flags.push(...reading_flags(command).filter((flag) => !target.flags.includes(flag)));
  }
  return [...targets.values()].map((target) => ({ ...target, files: target.files.sort() }));
}

const text_of = (file) => (existsSync(file) ? readFileSync(file, "utf8") : "");

/// Changes with everything that a target's result depends on but the system.
function digest_of(target, shared) {
  const digest = createHash("sha256").update(shared).update(target.flags.join("\n"));
  for (const file of target.files) {
    const text = text_of(file);
    digest.update(text);
    // Files that CMake compiles several at once include the sources.
    if (file.includes("/Unity/")) for (const [, source] of text.matchAll(/#include "([^"]+)"/g)) digest.update(text_of(source));
  }
  return digest.digest("hex");
}

/// What clang-tidy says of a target; empty where it is clean.
export function check(target, folder, filter) {
  const file = path.join(folder, `${target.name}.cpp`);
  writeFileSync(file, target.files.map((source) => `#include "${source}"\n`).join(""));
  const options = ["--quiet", `--config-file=${path.resolve(".clang-tidy")}`, `--header-filter=${filter}`, file, "--", "-w", ...target.flags];
  return new Promise((resolve) => {
    execFile("clang-tidy", options, { maxBuffer: 1 << 28 }, (error, out) => resolve(error ? out || String(error) : ""));
  });
}

export async function check_all(build) {
  const git = (...words) => execFileSync("git", ["ls-files", ...words], { encoding: "utf8" }).split("\n").filter(Boolean);
  const headers = git("*.h");
  const rooms = [...new Set(git("*.cpp").map((file) => file.split("/")[0]))].filter((room) => room !== "tests");
  const filter = `^${process.cwd()}/(${rooms.join("|")})/`;
  const shared = [execFileSync("clang-tidy", ["--version"], { encoding: "utf8" }), text_of(".clang-tidy"), ...headers.map(text_of)].join("\0");
  const folder = path.resolve(build, "tidy");
  mkdirSync(folder, { recursive: true });
  const waiting = targets_of(JSON.parse(readFileSync(path.join(build, "compile_commands.json"), "utf8")))
    .map((target) => ({ ...target, digest: digest_of(target, shared), clean: path.join(folder, `${target.name}.clean`) }))
    .filter(({ digest, clean }) => text_of(clean) !== digest);
  const found = [];
  const work = async () => {
    for (let target = waiting.shift(); target; target = waiting.shift()) {
      const said = await check(target, folder, filter);
      if (said) found.push(said);
      else writeFileSync(target.clean, target.digest);
    }
  };
  await Promise.all(Array.from({ length: availableParallelism() }, work));
  return found;
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const found = await check_all(process.argv[2] ?? "build");
  if (found.length) console.error(found.join("\n"));
  process.exitCode = found.length ? 1 : 0;
}
