// Pictures at one device pixel per picture pixel or a whole multiple, and two of them flipped in the
// same place by the viewer's own hand. Zoom and position stay while flipping.

import { h, icon } from "/assets/shared/dom.js";

const zooms = [1, 2, 4, 8];  // device pixels per picture pixel: whole numbers keep every pixel equal

export class Viewer {
  /// Opens over the page. `on_flip` and `on_show(slot)` are told what was looked at.
  constructor({ pictures, strings, on_flip, on_show }) {
    Object.assign(this, { pictures, strings, on_flip, on_show });
    this.zoom = 0;
    this.shown = null;
    this.other = null;
    this.image = h("img", { alt: "" });
    this.stage = h("div", { class: "viewer-stage", tabindex: "0", role: "group" }, this.image);
    this.spoken = h("p", { class: "unseen", role: "status" });
    this.flip_button = this.button("flip", "flip", () => this.flip());
    this.closer_button = this.button("closer", "closer", () => this.zoom_by(1));
    this.further_button = this.button("further", "further", () => this.zoom_by(-1));
    this.thumbnails = new Map([...pictures.values()].map((picture) => [picture.slot, h("button", {
      type: "button", class: "thumbnail", "aria-label": picture.name, "aria-pressed": "false",
      on: { click: () => this.choose(picture.slot) },
    }, h("img", { src: picture.url, alt: "" }), h("span", { "aria-hidden": "true" }, picture.letter))]));
    this.dialog = h("dialog", { class: "viewer", "aria-label": strings.viewer,
      on: { keydown: (event) => this.key(event), close: () => this.closed() } },
    this.stage,
    h("div", { class: "viewer-bar" },
      h("div", { class: "thumbnails", role: "group", "aria-label": strings.viewer_hint }, [...this.thumbnails.values()]),
      h("div", { class: "viewer-tools" }, this.flip_button, this.closer_button, this.further_button,
        this.button("close", "close", () => this.dialog.close()))),
    this.spoken);
    this.make_pannable();
  }

  button(name, symbol, act) {
    return h("button", { type: "button", class: `tool ${name}`, title: this.strings[name], on: { click: act } },
      icon(symbol), h("span", {}, this.strings[name]));
  }

  open(slot) {
    document.body.append(this.dialog);
    this.dialog.showModal();
    this.resized = new AbortController();
    addEventListener("resize", () => this.measure(), { signal: this.resized.signal });
    this.choose(slot);
    this.stage.focus();
  }

  closed() {
    this.resized.abort();
    this.dialog.remove();
  }

  /// The chosen picture comes up; the one before it stands ready for flipping.
  choose(slot) {
    if (slot === this.shown) return;
    this.other = this.shown;
    this.display(slot);
    this.on_show(slot);
  }

  flip() {
    if (this.other === null) return;
    [this.shown, this.other] = [this.other, this.shown];
    this.display(this.shown);
    this.on_flip();
  }

  display(slot) {
    const picture = this.pictures.get(slot);
    this.shown = slot;
    this.image.src = picture.url;
    this.image.alt = picture.name;
    for (const [each, thumbnail] of this.thumbnails) {
      thumbnail.setAttribute("aria-pressed", String(each === slot));
      thumbnail.classList.toggle("other", each === this.other);
    }
    this.flip_button.setAttribute("aria-disabled", String(this.other === null));
    this.flip_button.setAttribute("aria-label", this.other === null ? this.strings.flip
      : this.strings.flip_with(this.pictures.get(this.other).name));
    this.spoken.textContent = this.strings.shown_now(picture.name);
    this.measure();
  }

  zoom_by(step) {
    const before = zooms[this.zoom];
    this.zoom = Math.min(zooms.length - 1, Math.max(0, this.zoom + step));
    const scale = zooms[this.zoom] / before;
    const middle = [this.stage.scrollLeft + this.stage.clientWidth / 2, this.stage.scrollTop + this.stage.clientHeight / 2];
    this.measure();
    this.stage.scrollTo(middle[0] * scale - this.stage.clientWidth / 2, middle[1] * scale - this.stage.clientHeight / 2);
  }

  measure() {
    const picture = this.pictures.get(this.shown);
    const scale = zooms[this.zoom] / devicePixelRatio;
    this.image.style.width = `${picture.width * scale}px`;
    this.image.style.height = `${picture.height * scale}px`;
    this.closer_button.setAttribute("aria-disabled", String(this.zoom === zooms.length - 1));
    this.further_button.setAttribute("aria-disabled", String(this.zoom === 0));
  }

  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const on_button = event.target.closest("button") !== null;
    const step = (by) => {
      const slots = [...this.pictures.keys()];
      this.choose(slots[(slots.indexOf(this.shown) + by + slots.length) % slots.length]);
    };
    const keys = {
      " ": () => this.flip(),
      "+": () => this.zoom_by(1),
      "=": () => this.zoom_by(1),
      "-": () => this.zoom_by(-1),
      PageUp: () => step(-1),
      PageDown: () => step(1),
    };
    if (!keys[event.key] || (event.key === " " && on_button)) return;
    event.preventDefault();
    keys[event.key]();
  }

  make_pannable() {
    let from = null;
    this.stage.addEventListener("pointerdown", (event) => {
      if (event.pointerType !== "mouse" || event.button !== 0) return;
      from = [event.clientX + this.stage.scrollLeft, event.clientY + this.stage.scrollTop];
      this.stage.setPointerCapture(event.pointerId);
    });
    this.stage.addEventListener("pointermove", (event) => {
      if (from) this.stage.scrollTo(from[0] - event.clientX, from[1] - event.clientY);
    });
    this.stage.addEventListener("pointerup", () => (from = null));
    this.stage.addEventListener("pointercancel", () => (from = null));
  }
}
