// Small tables that scroll by themselves where a window is too narrow for them.

import { h } from "/assets/shared/dom.js";

/// `columns` are headings; each row is its heading and its cells, text or numbers. `name` is shown as the
/// caption unless `captioned` is false.
export function plain_table(name, columns, rows, { captioned = true } = {}) {
  return h("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": name },
    h("table", { class: "plain" }, captioned ? h("caption", {}, name) : null,
      h("thead", {}, h("tr", {}, columns.map((column) => h("th", { scope: "col" }, column)))),
      h("tbody", {}, rows.map(([heading, ...cells]) => h("tr", {}, h("th", { scope: "row" }, heading),
        cells.map((cell) => h("td", { class: /^[\d–<-]/.test(String(cell)) ? "number" : null }, String(cell))))))));
}
