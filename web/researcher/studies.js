// All studies, and putting in a new one.

import { h } from "/assets/shared/dom.js";
import { get, post } from "/assets/shared/http.js";
import { words_of } from "./words.js";

const statuses = { draft: "Draft", publishing: "Rendering its pictures", open: "Open", closed: "Closed" };

export const status_badge = (status) => h("span", { class: `badge ${status}` }, statuses[status] ?? status);

function upload() {
  const outcome = h("p", { role: "alert", class: "problems" });
  const file = h("input", { type: "file", id: "study-file", accept: ".json,application/json" });
  file.addEventListener("change", async () => {
    outcome.textContent = "";
    try {
      const document = JSON.parse(await file.files[0].text());
      const study = await post("/api/v1/studies", document);
      location.hash = `#study/${encodeURIComponent(study.id)}`;
    } catch (error) {
      outcome.textContent = error instanceof SyntaxError ? `This file is not JSON: ${error.message}` : words_of(error);
    }
    file.value = "";
  });
  return h("section", { class: "card upload" }, h("h2", {}, "New study"),
    h("p", {}, "A study is one JSON file. It arrives as a draft; nobody can enter before it is published."),
    h("label", { for: "study-file" }, "Study file"), file, outcome);
}

export async function studies_view() {
  const { studies } = await get("/api/v1/studies");
  return h("div", {}, h("h1", { tabindex: "-1" }, "Studies"),
    studies.length ? h("ul", { class: "studies" }, studies.map((study) => h("li", { class: "card" },
      h("h2", {}, h("a", { href: `#study/${encodeURIComponent(study.id)}` }, study.title)),
      h("p", {}, status_badge(study.status), h("code", {}, study.id)),
      h("p", { class: "counts" }, h("strong", {}, String(study.participants.completed)), " completed, ",
        h("strong", {}, String(study.participants.entered)), " entered"))))
      : h("p", {}, "There is no study yet."),
    upload());
}
