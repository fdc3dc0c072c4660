// Building elements. Everything goes through attributes and text nodes, never through markup, so
// that no text of a study can become part of the page's structure.

const svg_namespace = "http://www.w3.org/2000/svg";

function apply(element, properties) {
  for (const [name, value] of Object.entries(properties)) {
    if (value === null || value === undefined || value === false) continue;
    if (name === "on") {
      for (const [event, listener] of Object.entries(value)) element.addEventListener(event, listener);
    } else if (name === "data") {
      for (const [key, text] of Object.entries(value)) element.dataset[key] = text;
    } else if (name === "value") {
      element.value = value;
    } else {
      element.setAttribute(name, value === true ? "" : String(value));
    }
  }
  return element;
}

function append(element, children) {
  for (const child of children.flat(Infinity)) {
    if (child === null || child === undefined || child === false) continue;
    element.append(child);
  }
  return element;
}

export function h(tag, properties = {}, ...children) {
  return append(apply(document.createElement(tag), properties), children);
}

export function s(tag, properties = {}, ...children) {
  return append(apply(document.createElementNS(svg_namespace, tag), properties), children);
}

const icon_paths = {
  enlarge: "M9 3H3v6 M15 3h6v6 M21 15v6h-6 M3 15v6h6 M3 3l7 7 M21 3l-7 7 M21 21l-7-7 M3 21l7-7",
  close: "M5 5l14 14 M19 5L5 19",
  flip: "M4 8h13 M13 4l4 4-4 4 M20 16H7 M11 12l-4 4 4 4",
  beside: "M3 4h8v16H3z M13 4h8v16h-8z",
  closer: "M10.5 3a7.5 7.5 0 1 0 .01 0z M16 16l5 5 M10.5 7.5v6 M7.5 10.5h6",
  further: "M10.5 3a7.5 7.5 0 1 0 .01 0z M16 16l5 5 M7.5 10.5h6",
  swap: "M7 4v16 M3 8l4-4 4 4 M17 20V4 M13 16l4 4 4-4",
  check: "M4 12.5l5.5 5.5L20 6.5",
  copy: "M8 8h12v12H8z M16 8V4H4v12h4",
  previous: "M15 5l-7 7 7 7",
  next: "M9 5l7 7-7 7",
};

/// A line drawing in the text's colour, hidden from screen readers: its button carries the name.
export function icon(name) {
  return s("svg", { class: "icon", viewBox: "0 0 24 24", "aria-hidden": "true", focusable: "false" },
    s("path", { d: icon_paths[name] }));
}

/// Paragraphs of a study's text: blank lines part them.
export function paragraphs(text) {
  return String(text ?? "").split(/\n\s*\n/).filter((part) => part.trim() !== "")
    .map((part) => h("p", {}, part.trim()));
}

/// Replaces what is in `container` and moves the focus to the new heading, so that a screen
/// reader starts where a sighted reader does.
export function show(container, ...children) {
  container.replaceChildren(...children.flat(Infinity).filter(Boolean));
  window.scrollTo(0, 0);
  container.querySelector("h1[tabindex]")?.focus({ preventScroll: true });
}
