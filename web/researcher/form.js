// A form from a JSON Schema of flat parameters: nothing about a technique is written down twice.

import { h } from "/assets/shared/dom.js";

function field_of(name, schema, id) {
  if (schema.enum) return h("select", { id }, schema.enum.map((choice) => h("option", { value: choice }, choice)));
  if (schema.type === "boolean") return h("input", { type: "checkbox", id });
  const integer = schema.type === "integer";
  if (integer || schema.type === "number") {
    return h("input", { type: "number", id, min: schema.minimum, max: schema.maximum, step: integer ? "1" : "any", required: true });
  }
  return h("input", { type: "text", id });
}

function set_value(field, value) {
  if (field.type === "checkbox") field.checked = Boolean(value);
  else field.value = String(value);
}

export class ParameterForm {
  /// `values` override the schema's defaults (a preset's).
  constructor(schema, values = {}) {
    this.schema = schema;
    this.fields = new Map();
    const properties = Object.entries(schema.properties ?? {})
      .sort(([, a], [, b]) => (a["x-order"] ?? 0) - (b["x-order"] ?? 0));
    this.element = h("div", { class: "parameters" }, properties.map(([name, property]) => {
      const id = `parameter-${name}`;
      const field = field_of(name, property, id);
      set_value(field, values[name] ?? property.default ?? "");
      this.fields.set(name, field);
      const range = Number.isFinite(property.minimum) ? ` ${property.minimum} to ${property.maximum}` : "";
      const unit = property["x-unit"] ? ` ${property["x-unit"]}` : "";
      if (property.description) field.setAttribute("aria-describedby", `${id}-help`);
      return h("div", { class: "parameter" }, h("label", { for: id }, name.replaceAll("_", " "),
        unit ? h("span", { class: "unit" }, unit) : null), field,
      property.description ? h("p", { id: `${id}-help`, class: "small" }, `${property.description}${range ? ` (${range.trim()})` : ""}`) : null);
    }));
  }

  values() {
    return Object.fromEntries([...this.fields].map(([name, field]) => {
      const { type } = this.schema.properties[name];
      const value = field.type === "checkbox" ? field.checked : type === "string" ? field.value : field.valueAsNumber;
      return [name, value];
    }));
  }

  /// Marks the field that the server named.
  point_at(name) {
    const field = this.fields.get(name?.replace(/^parameters\./, ""));
    field?.focus();
    return Boolean(field);
  }
}
