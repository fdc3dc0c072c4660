// The researcher's pages: #studies, #study/ID/VERSION, #people/ID/VERSION, #edit/ID/VERSION, #copy/ID/VERSION, #new/TEMPLATE,
// #bench, #compare and #experiments.

import { h, show } from "/assets/shared/dom.js";
import { bench_view } from "./bench.js";
import { compare_view } from "./compare.js";
import { editor_view, template_view } from "./editor.js";
import { experiments_view } from "./experiments.js";
import { people_view } from "./people.js";
import { study_view } from "./study.js";
import { studies_view } from "./studies.js";
import { words_of } from "./words.js";

const main = document.getElementById("main");
let leaving = new AbortController();

/// Every view gets a signal that ends its polling when the next one opens.
async function route() {
  leaving.abort();
  leaving = new AbortController();
  const { signal } = leaving;
  const [place, id, version] = location.hash.slice(1).split("/").map(decodeURIComponent);
  const links = [...document.querySelectorAll("nav a")];
  const own = links.some((link) => link.hash === `#${place}`);  // all other pages are a study's
  for (const link of links) {
    const here = link.hash === (own ? `#${place}` : "#studies");
    if (here) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
  try {
    const views = {
      bench: () => bench_view(signal),
      compare: () => compare_view(signal),
      experiments: () => experiments_view(signal),
      study: () => study_view(id, version, signal),
      people: () => people_view(id, version),
      edit: () => editor_view(id, version, false),
      copy: () => editor_view(id, version, true),
      new: () => template_view(id),
    };
    const view = await (views[place] ?? studies_view)();
    if (!signal.aborted) show(main, view);
  } catch (error) {
    if (signal.aborted) return;
    show(main, h("section", { class: "card" }, h("h1", { tabindex: "-1" }, "This page cannot be shown"),
      h("p", { role: "alert" }, words_of(error)),
      h("button", { type: "button", class: "primary", on: { click: route } }, "Try again")));
  }
}

addEventListener("hashchange", route);
await route();
