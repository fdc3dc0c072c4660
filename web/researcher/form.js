// A form from a JSON Schema of flat parameters: nothing about a technique is written down twice.

import { h } from "/assets/shared/dom.js";

/// The input of one value.
export function field_of(name, schema, id) {
  if (schema.enum) return h("select", { id }, schema.enum.map((choice) => h("option", { value: choice }, choice)));
  if (schema.type === "boolean") return h("input", { type: "checkbox", id });
  const integer = schema.type === "integer";
  if (integer || schema.type === "number") {
    return h("input", { type: "number", id, min: schema.minimum, max: schema.maximum, step: integer ? "1" : "any", required: true });
  }
  return h("input", { type: "text", id });
}

export function set_value(field, value) {
  if (field.type === "checkbox") field.checked = Boolean(value);
  else field.value = String(value);
}

export function value_of(field, { type }) {
  if (field.type === "checkbox") return field.checked;
  if (field.type === "number") return field.valueAsNumber;
  return type === "string" ? field.value : Number(field.value);
}

const slider_steps = 200;

/// A slider for a number with both ends; by factors where the range spans more than a hundredfold.
function slider_of(field, schema, label) {
  const { minimum: low, maximum: high } = schema;
  if (field.type !== "number" || !Number.isFinite(low) || !Number.isFinite(high) || high <= low) return null;
  const by_factors = low > 0 && high / low > 100;
  const slider = h("input", { type: "range", min: "0", max: slider_steps, step: "1", "aria-label": `${label}, slider` });
  const place = (value) => slider_steps * (by_factors ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));
  const value = (share) => (by_factors ? low * (high / low) ** share : low + (high - low) * share);
  slider.value = String(place(field.valueAsNumber));
  slider.addEventListener("input", () => {
    const chosen = value(slider.valueAsNumber / slider_steps);
    field.value = String(schema.type === "integer" ? Math.round(chosen) : Number(chosen.toPrecision(4)));
  });
  field.addEventListener("input", () => (slider.value = String(place(field.valueAsNumber))));
  return slider;
}

export class ParameterForm {
  /// `values` override the schema's defaults (a preset's). `prefix` tells forms of one page apart.
  constructor(schema, values = {}, { prefix = "", sliders = false } = {}) {
    this.schema = schema;
    this.fields = new Map();
    this.rows = new Map();
    const properties = Object.entries(schema.properties ?? {})
      .sort(([, a], [, b]) => (a["x-order"] ?? 0) - (b["x-order"] ?? 0));
    this.element = h("div", { class: "parameters" }, properties.map(([name, property]) => {
      const id = `${prefix}parameter-${name}`;
      const field = field_of(name, property, id);
      set_value(field, values[name] ?? property.default ?? "");
      this.fields.set(name, field);
      const range = Number.isFinite(property.minimum) ? ` ${property.minimum} to ${property.maximum}` : "";
      const unit = property["x-unit"] ? ` ${property["x-unit"]}` : "";
      if (property.description) field.setAttribute("aria-describedby", `${id}-help`);
      const row = h("div", { class: "parameter" }, h("label", { for: id }, name.replaceAll("_", " "),
        unit ? h("span", { class: "unit" }, unit) : null), field, sliders ? slider_of(field, property, name.replaceAll("_", " ")) : null,
      property.description ? h("p", { id: `${id}-help`, class: "small" }, `${property.description}${range ? ` (${range.trim()})` : ""}`) : null);
      this.rows.set(name, row);
      return row;
    }));
    this.element.addEventListener("change", () => this.hide_without_effect());
    this.hide_without_effect();
  }

  values() {
    return Object.fromEntries([...this.fields].map(([name, field]) => [name, value_of(field, this.schema.properties[name])]));
  }

  /// Leaves out what changes nothing unless another parameter has a certain choice.
  hide_without_effect() {
    for (const [name, row] of this.rows)
      row.hidden = Object.entries(this.schema.properties[name]["x-only-with"] ?? {})
        .some(([other, choices]) => !choices.includes(this.fields.get(other)?.value));
  }

  /// Marks the field that the server named.
  point_at(name) {
    const field = this.fields.get(name?.replace(/^parameters\./, ""));
    field?.focus();
    return Boolean(field);
  }
}
