// Where things are in a JSON text, so that a fault is found without counting brackets.

/// {path: [from, to]} of every value of a valid JSON text; paths as the server names faults, such as
/// `pages[2].techniques[0]`. The text itself has the path "".
export function places_of(text) {
  const places = new Map();
  let at = 0;

  const skip_blanks = () => {
    while (/\s/.test(text[at] ?? "")) ++at;
  };

  /// Every member between brackets; `member` reads one, with the bracket or comma before it passed.
  const each_member = (closing, member) => {
    for (let index = 0; ; ++index) {
      ++at;
      skip_blanks();
      if (text[at] === closing) break;
      member(index);
      skip_blanks();
      if (text[at] === closing) break;
    }
    ++at;
  };

  const string = () => {
    const from = at;
    for (++at; text[at] !== '"'; ++at) if (text[at] === "\\") ++at;
    ++at;
    return JSON.parse(text.slice(from, at));
  };

  const value = (path) => {
    skip_blanks();
    const from = at;
    if (text[at] === "{") {
      each_member("}", () => {
        const key = string();
        skip_blanks();
        ++at;  // the colon
        value(path ? `${path}.${key}` : key);
      });
    } else if (text[at] === "[") {
      each_member("]", (index) => value(`${path}[${index}]`));
    } else if (text[at] === '"') {
      string();
    } else {
      while (/[^\s,\]}]/.test(text[at] ?? ",")) ++at;
    }
    places.set(path, [from, at]);
  };

  value("");
  return places;
}

/// Where `field` is, otherwise the innermost thing around it that is there; null for the whole.
export function place_of(text, field) {
  const places = places_of(text);
  for (let path = field; path; path = path.replace(/(\.[^.[\]]*|\[\d+\]|^[^.[\]]*)$/, "")) {
    if (places.has(path)) return places.get(path);
  }
  return null;
}

/// Where a text stops being JSON, by the browser's message; null where that does not say it.
export function place_of_syntax(text, { message }) {
  const position = /position (\d+)/.exec(message);
  const at = position ? Number(position[1]) : /end of JSON/.test(message) ? text.length : null;
  return at === null ? null : [Math.max(0, Math.min(at, text.length - 1)), Math.min(at + 1, text.length)];
}

export const line_of = (text, [from]) => text.slice(0, from).split("\n").length;
