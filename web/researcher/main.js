// The researcher's pages: #studies, #study/ID, #bench and #experiments.

import { h, show } from "/assets/shared/dom.js";
import { bench_view } from "./bench.js";
import { experiments_view } from "./experiments.js";
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
  const [place, id] = location.hash.slice(1).split("/").map(decodeURIComponent);
  for (const link of document.querySelectorAll("nav a")) {
    const here = link.hash === `#${place || "studies"}` || (place === "study" && link.hash === "#studies");
    if (here) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
  try {
    const view = place === "bench" ? await bench_view(signal)
      : place === "experiments" ? await experiments_view(signal)
      : place === "study" ? await study_view(id, signal) : await studies_view();
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
