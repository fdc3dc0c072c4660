// All studies, and putting in a new one.

import { h } from "/assets/shared/dom.js";
import { get } from "/assets/shared/http.js";
import { store_file } from "./editor.js";

const statuses = { draft: "Draft", publishing: "Rendering its pictures", open: "Open", closed: "Closed" };

export const status_badge = (status) => h("span", { class: `badge ${status}` }, statuses[status] ?? status);

/// What a new study can be written from: templates of the laboratory, and the studies there are.
function template_choice(studies, templates) {
  const option = (way) => ({ id, title }) => h("option", { value: `#${way}/${encodeURIComponent(id)}` }, `${title} (${id})`);
  const group = (label, options) => (options.length ? h("optgroup", { label }, options) : null);
  return h("select", { id: "study-template" }, group("Templates", templates.map(option("new"))), group("Studies here", studies.map(option("copy"))));
}

function upload(studies, templates) {
  const outcome = h("div", { role: "alert", class: "problems" });
  const file = h("input", { type: "file", id: "study-file", accept: ".json,application/json,.zip,application/zip" });
  file.addEventListener("change", async () => {
    const [chosen] = file.files;
    await store_file(chosen, outcome);
    file.value = "";
  });
  const template = template_choice(studies, templates);
  return h("section", { class: "card upload" }, h("h2", {}, "New study"),
    h("p", {}, "A study is one JSON file, or a zip of study.json and pictures of your own. It arrives as a draft; no one can enter before it is published."),
    h("div", { class: "ways" },
      h("div", {}, h("label", { for: "study-template" }, "From a template"), template, " ",
        h("button", { type: "button", class: "quiet", on: { click: () => {
          location.hash = template.value;
        } } }, "Write a copy")),
      h("div", {}, h("label", { for: "study-file" }, "From a file"), file)),
    outcome);
}

/// What is shown beside the version that a study is known by.
function beside(study) {
  const draft = study.versions.find((version) => version.version !== study.version && version.status === "draft");
  return draft ? h("small", {}, `with a draft of version ${draft.version}`) : null;
}

export async function studies_view() {
  const [{ studies }, { templates }] = await Promise.all([get("/api/v1/studies"), get("/api/v1/templates")]);
  return h("div", {}, h("h1", { tabindex: "-1" }, "Studies"),
    studies.length ? h("ul", { class: "studies" }, studies.map((study) => h("li", { class: "card" },
      h("h2", {}, h("a", { href: `#study/${encodeURIComponent(study.id)}` }, study.title)),
      h("p", {}, status_badge(study.status), h("code", {}, study.id), " ", beside(study)),
      h("p", { class: "counts" }, h("strong", {}, String(study.participants.completed)), " completed, ",
        h("strong", {}, String(study.participants.entered)), " entered"))))
      : h("p", {}, "There is no study yet."),
    upload(studies, templates));
}
