// Pictures of one size side by side, zoomed and moved together; the first two flip in place.

import { h, icon } from "/assets/shared/dom.js";

const largest = 32;
const step = 1.5;    // of one press or turn of the wheel
const stride = 0.1;  // of a pane's side, for one press of an arrow

export class Lens {
  /// Panes: [{name, url}]; the first two are what F flips.
  constructor(panes) {
    this.zoom = 1;
    this.x = 0.5;  // the pictures' point in the middle of the panes, 0 to 1
    this.y = 0.5;
    this.panes = panes;
    this.flipped = false;
    this.images = panes.map(({ name, url }) => h("img", { src: url, alt: name, draggable: "false" }));
    this.captions = panes.map(({ name }) => h("figcaption", {}, name));
    this.told = h("span", { role: "status" });
    this.stage = h("div", { class: "lens", tabindex: "0", role: "group", "aria-label": "Pictures. F flips A and B, plus and minus zoom, arrows move, 0 shows all." },
      panes.map((_, index) => h("figure", {}, h("div", { class: "pane" }, this.images[index]), this.captions[index])));
    const button = (name, sign, act) => h("button", { type: "button", class: "quiet", on: { click: act } }, icon(sign), name);
    this.element = h("div", {}, this.stage, h("div", { class: "actions lens-actions" },
      button("Flip A and B (F)", "flip", () => this.flip()),
      button("Closer (+)", "closer", () => this.scale(step)),
      button("Further (−)", "further", () => this.scale(1 / step)),
      button("Show all (0)", "enlarge", () => this.reset()), this.told));
    this.listen();
    this.draw();
  }

  listen() {
    const keys = {
      f: () => this.flip(), F: () => this.flip(), "+": () => this.scale(step), "=": () => this.scale(step),
      "-": () => this.scale(1 / step), 0: () => this.reset(),
      ArrowLeft: () => this.move(-stride, 0), ArrowRight: () => this.move(stride, 0),
      ArrowUp: () => this.move(0, -stride), ArrowDown: () => this.move(0, stride),
    };
    this.stage.addEventListener("keydown", (event) => {
      if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      keys[event.key]();
    });
    this.stage.addEventListener("wheel", (event) => {
      const pane = event.target.closest(".pane");
      if (!pane) return;
      event.preventDefault();
      const box = pane.getBoundingClientRect();
      this.scale(event.deltaY < 0 ? step : 1 / step,
        (event.clientX - box.left) / box.width - 0.5, (event.clientY - box.top) / box.height - 0.5);
    }, { passive: false });
    this.stage.addEventListener("pointerdown", (event) => {
      if (!event.target.closest(".pane") || event.button !== 0) return;
      this.stage.setPointerCapture(event.pointerId);
      this.held = { x: event.clientX, y: event.clientY };
    });
    this.stage.addEventListener("pointermove", (event) => {
      if (!this.held) return;
      const side = this.stage.querySelector(".pane").clientWidth;
      this.move((this.held.x - event.clientX) / side, (this.held.y - event.clientY) / side);
      this.held = { x: event.clientX, y: event.clientY };
    });
    for (const end of ["pointerup", "pointercancel"]) this.stage.addEventListener(end, () => (this.held = null));
  }

  /// Moves by a share of what is seen.
  move(right, down) {
    this.x += right / this.zoom;
    this.y += down / this.zoom;
    this.draw();
  }

  /// The picture's point at (across, down) of a pane, measured from its middle, stays where it is.
  scale(factor, across = 0, down = 0) {
    const next = Math.min(largest, Math.max(1, this.zoom * factor));
    this.x += across / this.zoom - across / next;
    this.y += down / this.zoom - down / next;
    this.zoom = next;
    this.draw();
  }

  reset() {
    Object.assign(this, { zoom: 1, x: 0.5, y: 0.5 });
    this.draw();
  }

  /// Shows B where A is, and A where B is, so that a difference moves.
  flip() {
    this.flipped = !this.flipped;
    for (const index of [0, 1]) {
      const { name, url } = this.panes[this.flipped ? 1 - index : index];
      Object.assign(this.images[index], { src: url, alt: name });
      this.captions[index].textContent = name;
    }
    this.told.textContent = `${this.captions[0].textContent} is shown first.`;
  }

  draw() {
    const half = 0.5 / this.zoom;
    this.x = Math.min(1 - half, Math.max(half, this.x));
    this.y = Math.min(1 - half, Math.max(half, this.y));
    const place = `scale(${this.zoom}) translate(${100 * (0.5 - this.x)}%, ${100 * (0.5 - this.y)}%)`;
    for (const image of this.images) image.style.transform = place;
    this.stage.classList.toggle("near", this.zoom > 1);
  }
}
