// Experiments: what was measured over many pictures, and starting one.

import { h } from "/assets/shared/dom.js";
import { get, post, remove } from "/assets/shared/http.js";
import { words_of } from "./words.js";

const poll_ms = 1500;
const statuses = { queued: "Waiting", running: "Running", done: "Done", failed: "Failed", stopped: "Stopped" };
const kinds = { sweep: "Cost over scenes and sizes", tradeoff: "Error against time" };

function progress_of({ progress, status, error }) {
  if (error) return error.message;
  if (!progress || status === "stopped") return "";
  const left = Number.isFinite(progress.left_s) && status === "running"
    ? `, about ${Math.ceil(progress.left_s / 60)} min left` : "";
  return `${progress.done} of ${progress.total} runs${left}`;
}

function card(experiment, refresh) {
  const { kind, status, request, links } = experiment;
  const asked = Object.entries(request).filter(([name]) => name !== "kind")
    .map(([name, value]) => `${name}: ${[value].flat().join(", ")}`).join("; ");
  const stop = h("button", { type: "button", on: { click: async () => {
    await remove(links.self);
    refresh();
  } } }, "Stop");
  return h("li", { class: "card" }, h("h2", {}, kinds[kind] ?? kind),
    h("p", {}, h("span", { class: `badge ${status}` }, statuses[status] ?? status), " ", asked || "defaults"),
    h("p", { class: "counts" }, progress_of(experiment)),
    status === "done" ? h("p", {}, h("a", { href: links.report }, "Report"), " ", h("a", { href: links.results }, "results.csv")) : null,
    status === "queued" || status === "running" ? stop : null);
}

function form(refresh) {
  const field = (id, name, hint) => [h("label", { for: id }, name), h("input", { id, placeholder: hint })];
  const outcome = h("p", { role: "alert", class: "problems" });
  const kind = h("select", { id: "experiment-kind" },
    Object.entries(kinds).map(([value, text]) => h("option", { value }, text)));
  const value_of = (id) => document.getElementById(id).value.trim();
  const start = async (event) => {
    event.preventDefault();
    outcome.textContent = "";
    const scene_key = kind.value === "tradeoff" ? "scene" : "scenes";
    const request = { kind: kind.value };
    if (value_of("experiment-scenes")) request[scene_key] = value_of("experiment-scenes");
    if (value_of("experiment-techniques")) request.techniques = value_of("experiment-techniques");
    try {
      await post("/api/v1/experiments", request);
      refresh();
    } catch (error) {
      outcome.textContent = words_of(error);
    }
  };
  return h("form", { class: "card upload", on: { submit: start } }, h("h2", {}, "New experiment"),
    h("label", { for: "experiment-kind" }, "What is measured"), kind,
    field("experiment-scenes", "Scenes", "sweep:*x1600x3, boxes"),
    field("experiment-techniques", "Techniques", "shadow-map, pcss"),
    h("button", { type: "submit", class: "primary" }, "Start"), outcome);
}

export async function experiments_view(signal) {
  const list = h("ul", { class: "studies" });
  const refresh = async () => {
    const { experiments } = await get("/api/v1/experiments");
    list.replaceChildren(...experiments.map((experiment) => card(experiment, refresh)));
  };
  await refresh();
  const timer = setInterval(() => refresh().catch(() => {}), poll_ms);
  signal.addEventListener("abort", () => clearInterval(timer));
  return h("div", {}, h("h1", { tabindex: "-1" }, "Experiments"), list, form(refresh));
}
