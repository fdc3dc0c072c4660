// One picture on the bench: what a technique makes of a scene, beside the truth, with the numbers.

import { h } from "/assets/shared/dom.js";
import { ApiError, get, post } from "/assets/shared/http.js";
import { ParameterForm } from "./form.js";
import { finished, labelled, number_field, number_rows, parameters_of, passes, path_of, RequestForm, scene_select, technique_select } from "./renders.js";
import { words_of } from "./words.js";

function picture(name, url, alt) {
  const image = h("img", { src: url, alt });
  const figure = h("figure", {}, h("a", { href: url }, image), h("figcaption", {}, name));
  image.addEventListener("error", () => figure.replaceChildren(h("p", {}, `${name}: this picture cannot be shown.`)));
  return figure;
}

function numbers(record) {
  const rows = number_rows(record).filter(([, value]) => value !== "–");
  return h("table", { class: "plain" }, h("caption", {}, "Numbers"),
    h("tbody", {}, rows.map(([name, value]) => h("tr", {}, h("th", { scope: "row" }, name), h("td", { class: "number" }, value)))));
}

class Bench {
  constructor(scenes, techniques, presets, limits, signal) {
    Object.assign(this, { techniques, presets, signal });
    this.scene = scene_select("scene", scenes);
    this.technique = technique_select("technique", techniques, presets);
    this.size = number_field("size", limits.width, { value: limits.width.default, required: true });
    this.request_form = new RequestForm(limits);
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
    this.request_form.elements,
    this.go, this.state, this.problem, this.parameters);
    this.draw_parameters();
    this.element = h("div", {}, h("h1", { tabindex: "-1" }, "Bench"), h("div", { class: "bench" }, this.form, this.result));
  }

  draw_parameters() {
    this.parameter_form = new ParameterForm(...parameters_of(this.technique.value, this.techniques, this.presets));
    this.parameters.replaceChildren(this.parameter_form.element);
  }

  request() {
    const size = this.size.valueAsNumber;
    return {
      scene: this.scene.value,
      technique: this.technique.value,
      parameters: this.parameter_form.values(),
      width: size,
      height: size,
      ...this.request_form.values(),
      measure: true,
    };
  }

  async render() {
    this.go.disabled = true;
    this.problem.textContent = "";
    this.state.textContent = "Asking…";
    try {
      const asked = await post("/api/v1/renders", this.request());
      this.state.textContent = "Rendering and measuring…";
      this.draw(await finished(asked.id, this.signal, (text) => (this.state.textContent = text)));
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
    const reference = record.quality?.reference_id;
    const name = this.technique.selectedOptions[0].textContent;
    const scene = this.scene.selectedOptions[0].textContent;
    this.result.replaceChildren(...[
      h("div", { class: "pictures" },
        picture(name, path_of(record.id, "image.png"), `${scene} with ${name}`),
        reference ? picture("Reference", path_of(reference, "image.png"), `${scene}, converged area light`) : null,
        reference ? picture("Error", path_of(record.id, "error.png"), "Map of the difference to the reference") : null),
      h("div", { class: "tables" }, numbers(record), passes(record)),
      record.notes.length ? h("ul", { class: "small" }, record.notes.map((note) => h("li", {}, note))) : null,
      h("p", { class: "small" }, record.device ? `${record.device.name}, ${record.device.driver}. ` : "",
        h("a", { href: path_of(record.id, "image.exr") }, "Linear picture (EXR)")),
    ].filter(Boolean));
  }
}

export async function bench_view(signal) {
  const [{ scenes }, { techniques, presets }, { components }] =
    await Promise.all([get("/api/v1/scenes"), get("/api/v1/techniques"), get("/openapi.json")]);
  return new Bench(scenes, techniques, presets, components.schemas.RenderRequest.properties, signal).element;
}
