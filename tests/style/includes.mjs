// Who may include whom: CONTRIBUTING.md's table is the rule, every #include of the repository the case.
//   node tests/style/includes.mjs
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const everything = "everything";

/// Rooms of a table in Markdown: a row names its paths in code in the first column and what it may use
/// in the third.
export function rooms_of(markdown) {
  const rows = markdown.split("\n").filter((line) => line.startsWith("| `"));
  const paths_in = (cell) => [...cell.matchAll(/`([^`]+)`/g)].map((match) => match[1]);
  const rooms = rows
    .map((row) => row.split("|").map((cell) => cell.trim()))
    .filter((cells) => cells.length === 5)
    .map(([, first, , third]) => ({
      paths: paths_in(first),
      uses: third === everything ? [everything] : paths_in(third),
    }));
  return rooms;
}

/// The room with the longest path that a file's name begins with; undefined where there is none.
export function room_of(rooms, file) {
  let best;
  let length = 0;
  for (const room of rooms) {
    for (const path of room.paths) {
      if (file.startsWith(path) && path.length > length) [best, length] = [room, path.length];
    }
  }
  return best;
}

function used_rooms(rooms, room) {
  return rooms.filter((other) =>
    room.uses.some((use) =>
      use === everything
        ? true
        : use.endsWith("*")
          ? other.paths.some((path) => path.startsWith(use.slice(0, -1)))
          : other.paths.includes(use),
    ),
  );
}

/// Rooms that reach themselves through what they may use.
function circles(rooms) {
  const found = [];
  for (const start of rooms) {
    if (start.uses.includes(everything)) continue;
    const seen = new Set();
    const open = used_rooms(rooms, start).filter((room) => room !== start);
    while (open.length > 0) {
      const room = open.pop();
      if (seen.has(room)) continue;
      seen.add(room);
      open.push(...used_rooms(rooms, room).filter((next) => next !== room));
    }
    if (seen.has(start)) found.push(`${start.paths[0]} may use what may use it`);
  }
  return found;
}

/// What breaks the rule: `files` maps names to texts. Only includes from the repository's root count.
export function violations(rooms, files) {
  const found = circles(rooms);
  for (const room of rooms) {
    for (const use of room.uses) {
      const known = use === everything || use.endsWith("*") || rooms.some((r) => r.paths.includes(use));
      if (!known) found.push(`${room.paths[0]} may use ${use}, which has no row`);
    }
  }
  for (const [name, text] of Object.entries(files)) {
    const from = room_of(rooms, name);
    if (!from) {
      found.push(`${name}: no row of the table has it`);
      continue;
    }
    const allowed = used_rooms(rooms, from);
    text.split("\n").forEach((line, index) => {
      const include = /^\s*#\s*include\s+"([^"]+\/[^"]+)"/.exec(line);
      if (!include) return;
      const to = room_of(rooms, include[1]);
      if (to !== from && !allowed.includes(to))
        found.push(`${name}:${index + 1}: ${from.paths[0]} may not use ${include[1]}`);
    });
  }
  return found;
}

/// Folders at the root that no row names; what begins with a dot is none of the project's rooms.
export function unnamed_folders(rooms, names) {
  const folders = new Set(names.filter((name) => /^[^./][^/]*\//.test(name)).map((name) => `${name.split("/")[0]}/`));
  const named = (folder) => rooms.some((room) => room.paths.some((path) => path.startsWith(folder)));
  return [...folders].filter((folder) => !named(folder)).map((folder) => `${folder}: no row of the table names it`);
}

function main() {
  const root = new URL("../../", import.meta.url);
  const names = execFileSync("git", ["ls-files", "--cached", "--others", "--exclude-standard"], {
    cwd: root,
    encoding: "utf8",
    maxBuffer: 1 << 26,
  }).split("\n");
  const files = {};
  for (const name of names.filter((each) => /\.(h|cpp|glsl|vert|frag|geom|comp)$/.test(each))) {
    try {
      files[name] = readFileSync(new URL(name, root), "utf8");
    } catch (error) {
      if (error.code !== "ENOENT") throw error; // removed, but still in the index
    }
  }
  const rooms = rooms_of(readFileSync(new URL("CONTRIBUTING.md", root), "utf8"));
  const found = [...violations(rooms, files), ...unnamed_folders(rooms, names)];
  for (const line of found) console.error(line);
  process.exitCode = found.length > 0 ? 1 : 0;
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) main();
