// A study file in the page: written from a template or a copy, checked by the server, stored as draft.

import { h } from "/assets/shared/dom.js";
import { get, post } from "/assets/shared/http.js";
import { line_of, place_of, place_of_syntax } from "./places.js";
import { words_of } from "./words.js";

/// What is wrong with a study, all at once: [{field, message}].
function faults_of(error) {
  return error.errors?.length ? error.errors : [{ field: "", message: words_of(error) }];
}

/// The faults in words; `to_line(fault)` makes the button that leads to where one is in the text.
function faults_list(faults, to_line) {
  const item = (fault) => [fault.field ? [h("code", {}, fault.field), ": "] : null, fault.message, to_line(fault)];
  return faults.length === 1 && !faults[0].field ? h("p", {}, item(faults[0]))
    : [h("p", {}, faults.length === 1 ? "One thing is wrong with this study:" : `${faults.length} things are wrong with this study:`),
      h("ul", {}, faults.map((fault) => h("li", {}, item(fault))))];
}

/// Shows a stretch of the text: selected, in the middle of the field, which takes the focus.
function select_in(field, [from, to]) {
  field.focus();
  field.setSelectionRange(from, to);
  const line_height = field.scrollHeight / field.value.split("\n").length;
  field.scrollTop = (line_of(field.value, [from]) - 1) * line_height - field.clientHeight / 2;
  field.scrollLeft = 0;
}

/// Faults with where they are in the text, where that is known.
const with_places = (faults, text) => faults.map((fault) => ({ ...fault,
  place: fault.place ?? (text && fault.field ? place_of(text, fault.field) : null) }));

/// Says what is wrong with the text of `field`, with the line of each fault, and goes to the first.
function show_faults(faults, field, outcome) {
  const placed = with_places(faults, field.value);
  outcome.replaceChildren(...[faults_list(placed, ({ place }) => place && [" ", h("button", { type: "button", class: "link",
    on: { click: () => select_in(field, place) } }, `line ${line_of(field.value, place)}`)])].flat());
  field.setAttribute("aria-invalid", "true");
  const first = placed.find(({ place }) => place);
  if (first) select_in(field, first.place);
}

const upload_ms = 300_000;  // a zip's pictures are read one by one

/// Stores a study, JSON text or a zip, and shows it. Faults go to `tell`.
async function store(study_file, tell) {
  try {
    const body = study_file instanceof Blob ? study_file : JSON.parse(study_file);
    const study = await post("/api/v1/studies", body, { deadline_ms: upload_ms });
    location.hash = `#study/${encodeURIComponent(study.id)}/${study.version}`;
  } catch (error) {
    tell(error instanceof SyntaxError
      ? [{ field: "", message: `This is not JSON: ${error.message}`, place: place_of_syntax(study_file, error) }] : faults_of(error));
  }
}

/// Stores a file. Its faults are in `outcome`, with their lines where it is a text.
export async function store_file(file, outcome) {
  outcome.replaceChildren();
  const text = file.name.toLowerCase().endsWith(".zip") ? null : await file.text();
  await store(text ?? file, (faults) => outcome.replaceChildren(...[faults_list(with_places(faults, text ?? ""),
    ({ place }) => place && ` (line ${line_of(text, place)})`)].flat()));
}

/// A name for a picture that a study can have as id.
const picture_id = (name) => name.replace(/\.[^.]*$/, "").toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-+|-+$/g, "").slice(0, 64) || "picture";

/// Own pictures: uploaded from here, and written into the study's text where its cursor is.
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
  const outcome = h("div", { class: "problems", id: "study-faults", role: "alert" });
  const text = h("textarea", { id: "study-text", class: "document", rows: "30", wrap: "off", spellcheck: "false", autocomplete: "off",
    "aria-describedby": "study-faults" });
  text.value = JSON.stringify(document, null, 2);
  return h("div", {}, h("p", {}, h("a", { href: "#studies" }, "All studies")),
    h("h1", { tabindex: "-1" }, heading),
    h("section", { class: "card" },
      document.about ? h("p", {}, document.about) : null,
      h("p", {}, made ? "Give it an id of its own; it becomes part of its address." : "Stored as a draft. What is open stays open until you publish the draft."),
      h("label", { for: "study-text" }, "Study file (JSON)"), text, outcome,
      h("div", { class: "actions" },
        h("button", { type: "button", class: "primary", on: { click: () => {
          outcome.replaceChildren();
          text.removeAttribute("aria-invalid");
          return store(text.value, (faults) => show_faults(faults, text, outcome));
        } } }, "Check and store as draft"),
        h("a", { class: "quiet", href: back }, "Cancel"))),
    own_pictures(text));
}
