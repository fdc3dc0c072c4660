// A study file in the page: written from a template or a copy, checked by the server, stored as draft.

import { h } from "/assets/shared/dom.js";
import { get, post } from "/assets/shared/http.js";
import { words_of } from "./words.js";

/// What is wrong with a study, all at once: [{field, message}].
export function faults_of(error) {
  return error.errors?.length ? error.errors : [{ field: "", message: words_of(error) }];
}

export function faults_list(faults) {
  return faults.length === 1 && !faults[0].field ? h("p", {}, faults[0].message)
    : [h("p", {}, faults.length === 1 ? "One thing is wrong with this study:" : `${faults.length} things are wrong with this study:`),
      h("ul", {}, faults.map(({ field, message }) => h("li", {}, field ? [h("code", {}, field), ": "] : null, message)))];
}

/// Stores a study and shows it. Faults stand in `outcome`.
export async function store(text, outcome) {
  outcome.replaceChildren();
  try {
    const study = await post("/api/v1/studies", JSON.parse(text));
    location.hash = `#study/${encodeURIComponent(study.id)}/${study.version}`;
  } catch (error) {
    const faults = error instanceof SyntaxError ? [{ field: "", message: `This is not JSON: ${error.message}` }] : faults_of(error);
    outcome.replaceChildren(...[faults_list(faults)].flat());
  }
}

/// `version` of study `from`; as a copy it gets another id.
export async function editor_view(from, version, copy) {
  const document = await get(`/api/v1/studies/${encodeURIComponent(from)}/study.json${version ? `?version=${version}` : ""}`);
  if (copy) document.id = `${document.id}-copy`.slice(0, 64);
  const outcome = h("div", { class: "problems", role: "alert" });
  const text = h("textarea", { id: "study-text", class: "document", rows: "30", spellcheck: "false", autocomplete: "off" });
  text.value = JSON.stringify(document, null, 2);
  return h("div", {}, h("p", {}, h("a", { href: "#studies" }, "All studies")),
    h("h1", { tabindex: "-1" }, copy ? `A new study, from ${from}` : `Edit ${from}`),
    h("section", { class: "card" },
      h("p", {}, copy ? "Give it an id of its own; it becomes part of its address." : "Stored as a draft. What is open stays open until you publish the draft."),
      h("label", { for: "study-text" }, "Study file (JSON)"), text, outcome,
      h("div", { class: "actions" },
        h("button", { type: "button", class: "primary", on: { click: () => store(text.value, outcome) } }, "Check and store as draft"),
        h("a", { class: "quiet", href: copy ? "#studies" : `#study/${encodeURIComponent(from)}` }, "Cancel"))));
}
