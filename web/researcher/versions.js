// The versions of a study side by side, and what can be done with each.

import { h } from "/assets/shared/dom.js";
import { status_badge } from "./studies.js";

const day = (time) => (time ? new Date(time).toLocaleString() : "");

function dates(version) {
  if (version.closed_at) return `closed ${day(version.closed_at)}`;
  return version.opened_at ? `opened ${day(version.opened_at)}` : `stored ${day(version.created_at)}`;
}

/// `shown` is the version that the page is about; `actions(version)` are the buttons of one.
export function versions_table(study, shown, actions) {
  return h("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Versions" },
    h("table", { class: "plain versions" }, h("caption", {}, "Versions"),
      h("thead", {}, h("tr", {}, ["Version", "State", "Completed", "Entered", "What can be done"].map((name) => h("th", { scope: "col" }, name)))),
      h("tbody", {}, study.versions.map((version) => h("tr", version.version === shown ? { "aria-current": "true" } : {},
        h("th", { scope: "row" }, h("a", { href: `#study/${encodeURIComponent(study.id)}/${version.version}` }, String(version.version))),
        h("td", {}, status_badge(version.status), h("small", {}, dates(version))),
        h("td", { class: "number" }, version.hash ? String(version.participants.completed) : ""),
        h("td", { class: "number" }, version.hash ? String(version.participants.entered) : ""),
        h("td", {}, h("div", { class: "row-actions" }, actions(version))))))));
}
