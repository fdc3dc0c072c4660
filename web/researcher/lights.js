// Sliders for the lights of a scene: where each is, or where distant light comes from.

import { h } from "/assets/shared/dom.js";
import { significant } from "./words.js";

const axes = ["x", "y", "z"];
const steps = 200;  // of a slider, each way

export class LightForm {
  constructor({ lights, diagonal }) {
    this.sliders = [];
    this.element = h("details", { class: "lights" }, h("summary", {}, "Lights"), lights.map((light, number) => {
      const key = light.position ? "position" : "direction";
      // A light is moved by as much as the scene is wide; a direction has no length.
      const reach = key === "position" ? diagonal : 1;
      return h("fieldset", {}, h("legend", {}, `${light.name}, ${key}`), axes.map((axis, index) => {
        const id = `light-${number}-${axis}`;
        const first = light[key][index];
        const output = h("output", { for: id });
        const field = h("input", { type: "range", id, min: -steps, max: steps, step: "1", value: "0" });
        const value = () => (field.valueAsNumber === 0 ? first : first + (field.valueAsNumber * reach) / steps);
        const tell = () => (output.textContent = `${significant(value())}${key === "position" ? " m" : ""}`);
        field.addEventListener("input", tell);
        tell();
        this.sliders.push({ name: light.name, key, index, first: light[key], field, value });
        return h("div", { class: "parameter slider" }, h("label", { for: id }, axis), field, output);
      }));
    }));
  }

  /// What was moved, as a render's `lights` has it.
  values() {
    const lights = {};
    for (const { name, key, index, first, field, value } of this.sliders) {
      if (field.valueAsNumber === 0) continue;
      lights[name] ??= { [key]: [...first] };
      lights[name][key][index] = value();
    }
    return lights;
  }
}
