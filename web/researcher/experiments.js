// Experiments: what was measured over many pictures, and starting one.

import { h } from "/assets/shared/dom.js";
import { get, post, remove } from "/assets/shared/http.js";
import { words_of } from "./words.js";

const poll_ms = 1500;
const statuses = { queued: "Waiting", running: "Running", done: "Done", failed: "Failed", stopped: "Stopped" };
/** A key of a request as people read it. */
const label_of = (key) => `${key.name[0].toUpperCase()}${key.name.slice(1).replaceAll("_", " ")}`;

function progress_of({ progress, status, error }) {
  if (error) return error.message;
  if (!progress || status === "stopped") return "";
  const left = Number.isFinite(progress.left_s) && status === "running"
    ? `, about ${Math.ceil(progress.left_s / 60)} min left` : "";
  return `${progress.done} of ${progress.total} runs${left}`;
}

function card(experiment, titles, refresh) {
  const { kind, status, request, links } = experiment;
  const asked = Object.entries(request).filter(([name]) => name !== "kind")
    .map(([name, value]) => `${name}: ${[value].flat().join(", ")}`).join("; ");
  const stop = h("button", { type: "button", on: { click: async () => {
    await remove(links.self);
    refresh();
  } } }, "Stop");
  return h("li", { class: "card" }, h("h2", {}, titles.get(kind) ?? kind),
    h("p", {}, h("span", { class: `badge ${status}` }, statuses[status] ?? status), " ", asked || "defaults"),
    h("p", { class: "counts" }, progress_of(experiment)),
    status === "done" ? h("p", {}, h("a", { href: links.report }, "Report"), " ", h("a", { href: links.results }, "results.csv")) : null,
    status === "queued" || status === "running" ? stop : null);
}

function field(key) {
  const id = `experiment-${key.name}`;
  if (key.form === "flag")
    return [h("label", { for: id, class: "flag" }, h("input", { id, type: "checkbox" }), label_of(key))];
  const kind = key.form === "number" ? { type: "number", step: "any" } : { type: "text" };
  const input = h("input", { id, ...kind, required: key.required });
  const named = [h("label", { for: id }, label_of(key)), input];
  if (!key.example) return named;
  // Beside the input, not in it: still there while something is typed, and read out.
  input.setAttribute("aria-describedby", `${id}-help`);
  return [...named, h("p", { id: `${id}-help`, class: "small" }, `Such as ${key.example}`)];
}

/** What was filled in, by key; what was left empty takes the program's default. */
function filled(keys) {
  const request = {};
  for (const { name, form } of keys) {
    const input = document.getElementById(`experiment-${name}`);
    if (form === "flag") {
      if (input.checked) request[name] = true;
    } else if (input.value.trim())
      request[name] = form === "number" ? Number(input.value) : input.value.trim();
  }
  return request;
}

function form_of(kinds, refresh) {
  const outcome = h("p", { role: "alert", class: "problems" });
  const kind = h("select", { id: "experiment-kind" },
    kinds.map((each) => h("option", { value: each.kind }, each.title)));
  const keys = () => kinds.find((each) => each.kind === kind.value).keys;
  const fields = h("div", { class: "fields" });
  const show = () => fields.replaceChildren(...keys().flatMap(field));
  kind.addEventListener("change", show);
  show();
  const start = async (event) => {
    event.preventDefault();
    outcome.textContent = "";
    try {
      await post("/api/v1/experiments", { kind: kind.value, ...filled(keys()) });
      refresh();
    } catch (error) {
      outcome.textContent = words_of(error);
    }
  };
  return h("form", { class: "card upload", on: { submit: start } }, h("h2", {}, "New experiment"),
    h("label", { for: "experiment-kind" }, "What is measured"), kind, fields,
    h("button", { type: "submit", class: "primary" }, "Start"), outcome);
}

export async function experiments_view(signal) {
  const list = h("ul", { class: "studies" });
  const { kinds } = await get("/api/v1/experiments");
  const titles = new Map(kinds.map(({ kind, title }) => [kind, title]));
  const refresh = async () => {
    const { experiments } = await get("/api/v1/experiments");
    list.replaceChildren(...experiments.map((experiment) => card(experiment, titles, refresh)));
  };
  await refresh();
  const timer = setInterval(() => refresh().catch(() => {}), poll_ms);
  signal.addEventListener("abort", () => clearInterval(timer));
  return h("div", {}, h("h1", { tabindex: "-1" }, "Experiments"), list, form_of(kinds, refresh));
}
