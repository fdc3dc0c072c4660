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

const upload_ms = 300_000;  // a zip's pictures are read one by one

/// Stores a study, JSON text or a zip, and shows it. Faults stand in `outcome`.
export async function store(study_file, outcome) {
  outcome.replaceChildren();
  try {
    const body = study_file instanceof Blob ? study_file : JSON.parse(study_file);
    const study = await post("/api/v1/studies", body, { deadline_ms: upload_ms });
    location.hash = `#study/${encodeURIComponent(study.id)}/${study.version}`;
  } catch (error) {
    const faults = error instanceof SyntaxError ? [{ field: "", message: `This is not JSON: ${error.message}` }] : faults_of(error);
    outcome.replaceChildren(...[faults_list(faults)].flat());
  }
}

/// A name for a picture that a study can have as id.
const picture_id = (name) => name.replace(/\.[^.]*$/, "").toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-+|-+$/g, "").slice(0, 64) || "picture";

/// Own pictures: uploaded from here, and written into the study's text where its cursor stands.
function own_pictures(text) {
  const list = h("ul", { class: "own-pictures" });
  const state = h("p", { role: "status" });
  const problems = h("div", { class: "problems", role: "alert" });
  const files = h("input", { type: "file", id: "own-pictures", multiple: true, accept: "image/png,image/jpeg,image/webp" });

  const shown = (name, { picture, width, height }) => {
    const element = JSON.stringify({ id: picture_id(name), picture });
    const insert = h("button", { type: "button", class: "quiet", on: { click: () => {
      text.setRangeText(element, text.selectionStart, text.selectionEnd, "end");
      text.focus();
    } } }, "Write it at the cursor");
    return h("li", {}, h("img", { src: `/api/v1/pictures/${picture}`, alt: name, width: "96" }),
      h("div", {}, h("p", {}, `${name}, ${width} by ${height} pixels`), h("code", {}, element), insert));
  };

  const upload = async (chosen) => {
    problems.replaceChildren();
    for (const [index, file] of chosen.entries()) {
      state.textContent = `Uploading ${file.name}, ${index + 1} of ${chosen.length}…`;
      try {
        list.append(shown(file.name, await post("/api/v1/pictures", file, { deadline_ms: upload_ms })));
      } catch (error) {
        problems.append(h("p", {}, `${file.name}: ${words_of(error)}`));
      }
    }
    state.textContent = "";
  };

  files.addEventListener("change", async () => {
    await upload([...files.files]);
    files.value = "";
  });
  return h("section", { class: "card upload", on: {
    dragover: (event) => event.preventDefault(),
    drop: (event) => {
      event.preventDefault();
      upload([...event.dataTransfer.files]);
    },
  } }, h("h2", {}, "Pictures of your own"),
  h("p", {}, "PNG, JPEG or WebP files of the study's picture size, chosen or dropped here. They are ranked beside rendered pictures: "
    + "put what is shown for each among the techniques of the study or of a page, and give it an id of your own choice."),
  h("label", { for: "own-pictures" }, "Picture files"), files, state, problems, list);
}

/// `version` of study `from`; as a copy it gets another id.
export async function editor_view(from, version, copy) {
  const document = await get(`/api/v1/studies/${encodeURIComponent(from)}/study.json${version ? `?version=${version}` : ""}`);
  if (copy) document.id = `${document.id}-copy`.slice(0, 64);
  return form({ document, made: copy, heading: copy ? `A new study, from ${from}` : `Edit ${from}`,
    back: copy ? "#studies" : `#study/${encodeURIComponent(from)}` });
}

/// A new study from a template of the laboratory.
export async function template_view(template) {
  const document = await get(`/api/v1/templates/${encodeURIComponent(template)}`);
  return form({ document, made: true, heading: `A new study, from ${template}`, back: "#studies" });
}

/// `made` where it becomes a study of its own; `back` is where cancelling leads.
function form({ document, made, heading, back }) {
  const outcome = h("div", { class: "problems", role: "alert" });
  const text = h("textarea", { id: "study-text", class: "document", rows: "30", spellcheck: "false", autocomplete: "off" });
  text.value = JSON.stringify(document, null, 2);
  return h("div", {}, h("p", {}, h("a", { href: "#studies" }, "All studies")),
    h("h1", { tabindex: "-1" }, heading),
    h("section", { class: "card" },
      document.about ? h("p", {}, document.about) : null,
      h("p", {}, made ? "Give it an id of its own; it becomes part of its address." : "Stored as a draft. What is open stays open until you publish the draft."),
      h("label", { for: "study-text" }, "Study file (JSON)"), text, outcome,
      h("div", { class: "actions" },
        h("button", { type: "button", class: "primary", on: { click: () => store(text.value, outcome) } }, "Check and store as draft"),
        h("a", { class: "quiet", href: back }, "Cancel"))),
    own_pictures(text));
}
