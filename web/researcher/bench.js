// One picture on the bench: what a technique makes of a scene, beside the truth, with the numbers.

import { h } from "/assets/shared/dom.js";
import { ApiError, get, post } from "/assets/shared/http.js";
import { ParameterForm } from "./form.js";
import { bytes, fixed, significant, words_of } from "./words.js";

const wait_s = 20;
const over = new Set(["done", "failed", "cancelled"]);

function select(id, entries) {
  return h("select", { id }, entries.map(([value, text]) => h("option", { value }, text)));
}

const labelled = (name, field) => h("div", { class: "parameter" }, h("label", { for: field.id }, name), field);

function picture(name, url, alt) {
  const image = h("img", { src: url, alt });
  const figure = h("figure", {}, h("a", { href: url }, image), h("figcaption", {}, name));
  image.addEventListener("error", () => figure.replaceChildren(h("p", {}, `${name}: this picture cannot be shown.`)));
  return figure;
}

function numbers(record) {
  const { quality, cost } = record;
  const rows = [
    ["Error, RMS luminance (rms_y)", significant(quality?.rms_y)],
    ["of which noise of the reference", significant(quality?.reference_noise_rms_y)],
    ["PSNR", Number.isFinite(quality?.psnr) ? `${fixed(quality.psnr, 2)} dB` : "–"],
    ["SSIM", fixed(quality?.ssim, 4)],
    ["FLIP", fixed(quality?.flip, 4)],
    ["False shadow", significant(quality?.false_shadow)],
    ["Missing shadow", significant(quality?.missing_shadow)],
    ["Frame time, median", cost?.frame_ms ? `${significant(cost.frame_ms.median)} ms` : "–"],
    ["Frame time, 95th percentile", cost?.frame_ms ? `${significant(cost.frame_ms.p95)} ms` : "–"],
    ["Spread of repeats (half the quartiles' distance)",
      cost?.frame_ms?.spread === undefined ? "–" : `${significant(100 * cost.frame_ms.spread)} %`],
    ["Frame time over that without shadows", significant(cost?.frame_ms?.over_none)],
    ["Times settled", cost?.frame_ms?.settled === false ? "no: do not compare them" : "–"],
    ["Memory over no shadows", bytes(cost?.memory?.over_none_bytes)],
  ].filter(([, value]) => value !== "–");
  return h("table", { class: "plain" }, h("caption", {}, "Numbers"),
    h("tbody", {}, rows.map(([name, value]) => h("tr", {}, h("th", { scope: "row" }, name), h("td", { class: "number" }, value)))));
}

function passes(record) {
  const list = record.cost?.passes ?? [];
  if (!list.length) return null;
  return h("table", { class: "plain" }, h("caption", {}, "Passes"),
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Pass"), h("th", { scope: "col" }, "Median"))),
    h("tbody", {}, list.map((pass) => h("tr", {}, h("th", { scope: "row" }, pass.name),
      h("td", { class: "number" }, `${significant(pass.median_ms)} ms`)))));
}

class Bench {
  constructor(scenes, techniques, presets, limits, signal) {
    Object.assign(this, { techniques, presets, signal });
    this.scene = select("scene", scenes.map(({ id, title }) => [id, title || id]));
    this.technique = select("technique", [
      ...techniques.map(({ id, title }) => [id, title || id]),
      ...presets.filter(({ id }) => !techniques.some((technique) => technique.id === id))
        .map(({ id, title }) => [id, `${title || id} (preset)`])]);
    this.size = h("input", { type: "number", id: "size", min: limits.width.minimum, max: limits.width.maximum, step: "1", value: limits.width.default, required: true });
    this.supersampling = select("supersampling", limits.supersampling.enum.map((count) => [String(count), String(count)]));
    this.light_samples = h("input", { type: "number", id: "light-samples", min: limits.light_samples.minimum, max: limits.light_samples.maximum, step: "1" });
    this.exposure = h("input", { type: "number", id: "exposure", min: limits.exposure.minimum, max: limits.exposure.maximum, step: "any" });
    this.parameters = h("div", {});
    this.technique.addEventListener("change", () => this.draw_parameters());
    this.go = h("button", { type: "submit", class: "primary" }, "Render");
    this.state = h("p", { role: "status" });
    this.problem = h("p", { class: "problems", role: "alert" });
    this.result = h("div", { class: "bench-result" });
    this.form = h("form", { class: "card bench-form", on: { submit: (event) => {
      event.preventDefault();
      this.render();
    } } },
    labelled("Scene", this.scene), labelled("Technique", this.technique), labelled("Width and height, pixels", this.size),
    labelled("Samples per pixel", this.supersampling), labelled("Light samples (empty: the default)", this.light_samples),
    labelled("Exposure, EV (empty: the scene's)", this.exposure),
    this.go, this.state, this.problem, this.parameters);
    this.draw_parameters();
    this.element = h("div", {}, h("h1", { tabindex: "-1" }, "Bench"), h("div", { class: "bench" }, this.form, this.result));
  }

  draw_parameters() {
    const preset = this.presets.find(({ id }) => id === this.technique.value);
    const technique = this.techniques.find(({ id }) => id === (preset?.technique ?? this.technique.value));
    this.parameter_form = new ParameterForm(technique.parameters, preset?.parameters);
    this.parameters.replaceChildren(this.parameter_form.element);
  }

  request() {
    const size = this.size.valueAsNumber;
    const samples = this.light_samples.valueAsNumber;
    const exposure = this.exposure.valueAsNumber;
    return {
      scene: this.scene.value,
      technique: this.technique.value,
      parameters: this.parameter_form.values(),
      width: size,
      height: size,
      supersampling: Number(this.supersampling.value),
      ...(Number.isFinite(samples) ? { light_samples: samples } : {}),
      ...(Number.isFinite(exposure) ? { exposure } : {}),
      measure: true,
    };
  }

  async finished(id) {
    for (;;) {
      const record = await get(`/api/v1/renders/${encodeURIComponent(id)}?wait_s=${wait_s}`, { deadline_ms: 1000 * (wait_s + 20) });
      if (over.has(record.status) || this.signal.aborted) return record;
      this.state.textContent = record.status === "queued" ? "Waiting for a free worker…"
        : `Rendering and measuring, ${Math.round(100 * record.progress)}%…`;
    }
  }

  async render() {
    this.go.disabled = true;
    this.problem.textContent = "";
    this.state.textContent = "Asking…";
    try {
      const asked = await post("/api/v1/renders", this.request());
      this.state.textContent = "Rendering and measuring…";
      this.draw(await this.finished(asked.id));
    } catch (error) {
      this.problem.textContent = words_of(error);
      if (error instanceof ApiError) this.parameter_form.point_at(error.field);
    }
    this.state.textContent = "";
    this.go.disabled = false;
  }

  draw(record) {
    if (record.status !== "done") {
      this.problem.textContent = record.error?.message ?? `The render was ${record.status}.`;
      return;
    }
    const path = (id, name) => `/api/v1/renders/${encodeURIComponent(id)}/${name}`;
    const reference = record.quality?.reference_id;
    const name = this.technique.selectedOptions[0].textContent;
    const scene = this.scene.selectedOptions[0].textContent;
    this.result.replaceChildren(...[
      h("div", { class: "pictures" },
        picture(name, path(record.id, "image.png"), `${scene} with ${name}`),
        reference ? picture("Reference", path(reference, "image.png"), `${scene}, converged area light`) : null,
        reference ? picture("Error", path(record.id, "error.png"), "Map of the difference to the reference") : null),
      h("div", { class: "tables" }, numbers(record), passes(record)),
      record.notes.length ? h("ul", { class: "small" }, record.notes.map((note) => h("li", {}, note))) : null,
      h("p", { class: "small" }, record.device ? `${record.device.name}, ${record.device.driver}. ` : "",
        h("a", { href: path(record.id, "image.exr") }, "Linear picture (EXR)")),
    ].filter(Boolean));
  }
}

export async function bench_view(signal) {
  const [{ scenes }, { techniques, presets }, { components }] =
    await Promise.all([get("/api/v1/scenes"), get("/api/v1/techniques"), get("/openapi.json")]);
  return new Bench(scenes, techniques, presets, components.schemas.RenderRequest.properties, signal).element;
}
