// Two techniques on the same view: their pictures, the reference and the error maps, seen through one
// lens, with costs beside.

import { h } from "/assets/shared/dom.js";
import { ApiError, get, post } from "/assets/shared/http.js";
import { ParameterForm } from "./form.js";
import { Lens } from "./lens.js";
import { finished, labelled, number_field, number_rows, parameters_of, path_of, RequestForm, scene_select, select, technique_select } from "./renders.js";
import { LightForm } from "./lights.js";
import { words_of } from "./words.js";

const sides = ["A", "B"];

/// One of the two techniques, with its parameters.
class Side {
  constructor(letter, techniques, presets, first) {
    this.technique = technique_select(`technique-${letter}`, techniques, presets);
    this.technique.value = first;
    const parameters = h("div", {});
    const draw = () => {
      this.form = new ParameterForm(...parameters_of(this.technique.value, techniques, presets), { prefix: `${letter}-`, sliders: true });
      parameters.replaceChildren(this.form.element);
    };
    this.technique.addEventListener("change", draw);
    draw();
    this.element = h("fieldset", {}, h("legend", {}, letter), labelled(`Technique ${letter}`, this.technique),
      h("details", {}, h("summary", {}, `Parameters of ${letter}`), parameters));
  }

  get name() {
    return this.technique.selectedOptions[0].textContent;
  }
}

class Compare {
  constructor({ scenes, techniques, presets, limits, signal }) {
    Object.assign(this, { limits, signal });
    this.scene = scene_select("scene", scenes);
    this.camera = select("camera", []);
    this.size = number_field("size", limits.width, { value: limits.width.default, required: true });
    this.request_form = new RequestForm(limits);
    this.sides = sides.map((letter, index) => new Side(letter, techniques, presets, techniques[Math.min(index, techniques.length - 1)].id));
    this.lights = h("div", {});
    this.go = h("button", { type: "submit", class: "primary" }, "Draw both");
    this.state = h("p", { role: "status" });
    this.problem = h("p", { class: "problems", role: "alert" });
    this.result = h("div", { class: "bench-result" });
    this.form = h("form", { class: "card bench-form", on: { submit: (event) => {
      event.preventDefault();
      this.render();
    } } },
    labelled("Scene", this.scene), labelled("Camera", this.camera), labelled("Width and height, pixels", this.size),
    this.request_form.elements,
    this.sides.map(({ element }) => element), this.lights, this.go, this.state, this.problem);
    this.scene.addEventListener("change", () => this.choose_scene());
    this.element = h("div", {}, h("h1", { tabindex: "-1" }, "Compare"), h("div", { class: "bench" }, this.form, this.result));
  }

  async choose_scene() {
    this.problem.textContent = "";
    try {
      const scene = await get(`/api/v1/scenes/${encodeURIComponent(this.scene.value)}`);
      if (scene.id !== this.scene.value) return;  // another was chosen meanwhile
      this.camera.replaceChildren(...scene.cameras.map((name) => h("option", { value: name }, name)));
      this.light_form = new LightForm(scene);
      this.lights.replaceChildren(this.light_form.element);
    } catch (error) {
      this.problem.textContent = words_of(error);
    }
  }

  request(side) {
    return {
      scene: this.scene.value,
      camera: this.camera.value,
      technique: side.technique.value,
      parameters: side.form.values(),
      lights: this.light_form.values(),
      width: this.size.valueAsNumber,
      height: this.size.valueAsNumber,
      ...this.request_form.values(),
      measure: true,
    };
  }

  async render() {
    this.go.disabled = true;
    this.problem.textContent = "";
    this.state.textContent = "Asking…";
    try {
      // Both are asked for before either is waited for, so that two workers have something to do.
      const asked = [];
      for (const side of this.sides) asked.push(await post("/api/v1/renders", this.request(side)));
      const records = [];
      for (const [index, { id }] of asked.entries())
        records.push(await finished(id, this.signal, (text) => (this.state.textContent = `${sides[index]}: ${text}`)));
      if (!this.signal.aborted) this.draw(records);
    } catch (error) {
      this.problem.textContent = words_of(error);
      if (error instanceof ApiError) this.sides.some((side) => side.form.point_at(error.field));
    }
    this.state.textContent = "";
    this.go.disabled = false;
  }

  draw(records) {
    const failed = records.findIndex(({ status }) => status !== "done");
    if (failed >= 0) {
      this.problem.textContent = `${sides[failed]}: ${records[failed].error?.message ?? records[failed].status}`;
      return;
    }
    const names = this.sides.map(({ name }, index) => `${sides[index]}: ${name}`);
    const panes = records.map((record, index) => ({ name: names[index], url: path_of(record.id, "image.png") }));
    const reference = records.map(({ quality }) => quality?.reference_id).find(Boolean);
    if (reference) panes.push({ name: "Reference", url: path_of(reference, "image.png") });
    for (const [index, { id, quality }] of records.entries())
      if (quality?.reference_id) panes.push({ name: `Error of ${sides[index]}`, url: path_of(id, "error.png") });
    const lens = new Lens(panes);
    this.result.replaceChildren(lens.element, h("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Numbers" },
      numbers(records, names)),
    h("ul", { class: "small" }, records.flatMap(({ notes }, index) => notes.map((note) => h("li", {}, `${sides[index]}: ${note}`)))));
  }
}

/// What was measured, a column for each.
function numbers(records, names) {
  const columns = records.map(number_rows);
  const rows = columns[0].map(([name], row) => [name, columns.map((column) => column[row][1])])
    .filter(([, values]) => values.some((value) => value !== "–"));
  return h("table", { class: "plain" }, h("caption", {}, "Numbers"),
    h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Measure"), names.map((name) => h("th", { scope: "col", class: "number" }, name)))),
    h("tbody", {}, rows.map(([name, values]) => h("tr", {}, h("th", { scope: "row" }, name),
      values.map((value) => h("td", { class: "number" }, value))))));
}

export async function compare_view(signal) {
  const [{ scenes }, { techniques, presets }, { components }] =
    await Promise.all([get("/api/v1/scenes"), get("/api/v1/techniques"), get("/openapi.json")]);
  const view = new Compare({ scenes, techniques, presets, limits: components.schemas.RenderRequest.properties, signal });
  await view.choose_scene();
  return view.element;
}
