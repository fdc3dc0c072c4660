// What the pages that draw pictures share: fields of a request, waiting for a render, its numbers.

import { h } from "/assets/shared/dom.js";
import { get } from "/assets/shared/http.js";
import { field_of, set_value, value_of } from "./form.js";
import { bytes, fixed, significant } from "./words.js";

const wait_s = 20;
const over = new Set(["done", "failed", "cancelled"]);

export const select = (id, entries) =>
  h("select", { id }, entries.map(([value, text]) => h("option", { value }, text)));

export const labelled = (name, field) => h("div", { class: "parameter" }, h("label", { for: field.id }, name), field);

export const scene_select = (id, scenes) => select(id, scenes.map((scene) => [scene.id, scene.title || scene.id]));

export const technique_select = (id, techniques, presets) => select(id, [
  ...techniques.map((technique) => [technique.id, technique.title || technique.id]),
  ...presets.filter((preset) => !techniques.some((technique) => technique.id === preset.id))
    .map((preset) => [preset.id, `${preset.title || preset.id} (preset)`])]);

/// A technique's schema, and the values that a preset has instead of defaults.
export function parameters_of(name, techniques, presets) {
  const preset = presets.find(({ id }) => id === name);
  const technique = techniques.find(({ id }) => id === (preset?.technique ?? name));
  return [technique.parameters, preset?.parameters];
}

/// Inputs for the fields of a request that the API's document gives an `x-label`. One without default
/// may stay empty, and is left out.
export class RequestForm {
  constructor(properties) {
    this.fields = Object.entries(properties)
      .filter(([, schema]) => schema["x-label"])
      .sort(([, a], [, b]) => a["x-order"] - b["x-order"])
      .map(([name, schema]) => {
        const input = field_of(name, schema, name.replaceAll("_", "-"));
        const optional = schema.default === undefined;
        input.required &&= !optional;
        set_value(input, schema.default ?? "");
        return { name, schema, input, label: `${schema["x-label"]}${optional ? ` (empty: ${schema["x-without"]})` : ""}` };
      });
    this.elements = this.fields.map(({ label, input }) => labelled(label, input));
  }

  values() {
    return Object.fromEntries(this.fields
      .filter(({ input }) => input.type === "checkbox" || input.value !== "")
      .map(({ name, schema, input }) => [name, value_of(input, schema)]));
  }
}

export const number_field = (id, limits, more = {}) =>
  h("input", { type: "number", id, min: limits.minimum, max: limits.maximum, step: limits.type === "integer" ? "1" : "any", ...more });

export const path_of = (id, name) => `/api/v1/renders/${encodeURIComponent(id)}/${name}`;

/// The render once it is over; `say` is told how it goes.
export async function finished(id, signal, say) {
  for (;;) {
    const record = await get(`/api/v1/renders/${encodeURIComponent(id)}?wait_s=${wait_s}`, { deadline_ms: 1000 * (wait_s + 20) });
    if (over.has(record.status) || signal.aborted) return record;
    say(record.status === "queued" ? "Waiting for a free worker…" : `Rendering and measuring, ${Math.round(100 * record.progress)}%…`);
  }
}

/// [name, text] of everything measured; a dash where it was not.
export function number_rows({ quality, cost }) {
  return [
    ["Error, RMS luminance (rms_y)", significant(quality?.rms_y)],
    ["of which noise of the reference", significant(quality?.reference_noise_rms_y)],
    ["PSNR", Number.isFinite(quality?.psnr) ? `${fixed(quality.psnr, 2)} dB` : "–"],
    ["SSIM", fixed(quality?.ssim, 4)],
    ["FLIP", fixed(quality?.flip, 4)],
    ["False shadow", significant(quality?.false_shadow)],
    ["Missing shadow", significant(quality?.missing_shadow)],
    ["Change between frames beyond the reference's", significant(quality?.frame_difference)],
    ["Frame time, median", cost?.frame_ms ? `${significant(cost.frame_ms.median)} ms` : "–"],
    ["Frame time, 95th percentile", cost?.frame_ms ? `${significant(cost.frame_ms.p95)} ms` : "–"],
    ["Spread of repeats (half the quartiles' distance)",
      cost?.frame_ms?.spread === undefined ? "–" : `${significant(100 * cost.frame_ms.spread)} %`],
    ["Frame time over that without shadows", significant(cost?.frame_ms?.over_none)],
    ["Times settled", cost?.frame_ms?.settled === false ? "no: do not compare them" : "–"],
    ["Memory over no shadows", bytes(cost?.memory?.over_none_bytes)],
  ];
}

export function passes(record) {
  const list = record.cost?.passes ?? [];
  if (!list.length) return null;
  return h("table", { class: "plain" }, h("caption", {}, "Passes"),
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Pass"), h("th", { scope: "col" }, "Median"))),
    h("tbody", {}, list.map((pass) => h("tr", {}, h("th", { scope: "row" }, pass.name),
      h("td", { class: "number" }, `${significant(pass.median_ms)} ms`)))));
}
