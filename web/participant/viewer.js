// Pictures at one device pixel per picture pixel or a whole multiple: one alone, two flipped in the
// same place, or two side by side, always by the viewer's own hand. Zoom and position stay the same.

import { h, icon } from "/assets/shared/dom.js";
import { turning_image } from "./orbit.js";
import { fit_to_device_pixels } from "./pixels.js";

const zooms = [1, 2, 4, 8];  // device pixels per picture pixel: whole numbers keep every pixel equal

export class Viewer {
  /// Opens over the page. `place_text(slot)` says where a picture is, `shelf_of(slot)` is its shelf
  /// from 0 to `lowest`, or null. `on_flip` and `on_show(slot)` are told what was looked at. `orbit`
  /// turns the pictures, where they can be turned.
  constructor({ pictures, strings, orbit, shelf_of, lowest, place_text, on_flip, on_show }) {
    Object.assign(this, { pictures, strings, orbit, shelf_of, lowest, place_text, on_flip, on_show });
    this.zoom = 0;
    this.shown = null;
    this.other = null;
    this.beside = false;
    this.panes = [this.make_pane(), this.make_pane()];
    this.row = h("div", { class: "panes" }, this.panes[0].element);
    this.spoken = h("p", { class: "unseen", role: "status" });
    this.flip_button = this.button("flip", "flip", () => this.flip());
    this.beside_button = this.button("beside", "beside", () => this.set_beside(!this.beside));
    this.closer_button = this.button("closer", "closer", () => this.zoom_by(1));
    this.further_button = this.button("further", "further", () => this.zoom_by(-1));
    this.thumbnails = new Map([...pictures.values()].map((picture) => [picture.slot, this.make_thumbnail(picture)]));
    this.dialog = h("dialog", { class: "viewer", "aria-label": strings.viewer,
      on: { keydown: (event) => this.key(event), close: () => this.closed() } },
    this.row,
    h("div", { class: "viewer-bar" },
      h("div", { class: "thumbnails", role: "group", "aria-label": strings.viewer_hint }, [...this.thumbnails.values()]),
      orbit?.control(),
      h("div", { class: "viewer-tools" }, this.flip_button, this.beside_button, this.closer_button, this.further_button,
        this.button("close", "close", () => this.dialog.close())),
      h("p", { class: "keys" }, strings.viewer_keys, orbit ? ` · ${strings.turn_keys}` : "")),
    this.spoken);
  }

  button(name, symbol, act) {
    return h("button", { type: "button", class: `tool ${name}`, title: this.strings[name], on: { click: act } },
      icon(symbol), h("span", {}, this.strings[name]));
  }

  /// One picture with its name and its place on the shelves.
  make_pane() {
    const image = turning_image(this.pictures.values().next().value, { alt: "" });
    const stage = h("div", { class: "viewer-stage", tabindex: "0", role: "group" }, image);
    const caption = h("figcaption", {});
    const pane = { image, stage, caption, element: h("figure", { class: "pane" }, stage, caption) };
    stage.addEventListener("scroll", () => {
      // A pane that was moved to follow the other must not lead it back to where that was.
      if (stage.scrollLeft !== pane.followed?.left || stage.scrollTop !== pane.followed.top) this.follow(pane);
    });
    this.make_pannable(stage);
    return pane;
  }

  /// The dot on the line beside a thumbnail is the picture's place between both ends of the shelves.
  make_thumbnail(picture) {
    const { slot, name, letter } = picture;
    const shelf = this.shelf_of(slot);
    const where = this.place_text(slot);
    const scale = h("span", { class: shelf === null ? "" : "thumb-place" });
    if (shelf !== null) scale.style.setProperty("--down", this.lowest > 0 ? shelf / this.lowest : 0);
    return h("button", { type: "button", class: "thumbnail", "aria-label": name, "aria-pressed": "false",
      title: where, on: { click: () => this.choose(slot) } },
    h("span", { class: "thumbnail-picture" }, turning_image(picture, { alt: "" }), scale),
    h("span", { "aria-hidden": "true" }, letter));
  }

  open(slot) {
    document.body.append(this.dialog);
    this.dialog.showModal();
    this.resized = new AbortController();
    // A window's zoom changes the ratio of pixels, a caption that wraps the stage alone.
    addEventListener("resize", () => this.measure(), { signal: this.resized.signal });
    this.stages = new ResizeObserver(() => this.measure());
    for (const { stage } of this.panes) this.stages.observe(stage);
    this.choose(slot);
    this.panes[0].stage.focus();
  }

  closed() {
    this.resized.abort();
    this.stages.disconnect();
    this.dialog.remove();
  }

  /// The chosen picture comes up; the one before it is ready for flipping, or beside it.
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

  /// Beside the picture shown is the one seen before it, or the next one.
  set_beside(beside) {
    if (beside && this.other === null) {
      const slots = [...this.pictures.keys()];
      if (slots.length < 2) return;
      this.other = slots[(slots.indexOf(this.shown) + 1) % slots.length];
      this.on_show(this.other);
    }
    this.beside = beside;
    this.display(this.shown);
  }

  display(slot) {
    this.shown = slot;
    const [first, second] = this.panes;
    if (this.beside) this.row.append(second.element);
    else second.element.remove();
    for (const [pane, which] of [[first, slot], ...(this.beside ? [[second, this.other]] : [])]) {
      const { url, name } = this.pictures.get(which);
      pane.image.dataset.turns = which;
      pane.image.src = url;
      pane.image.alt = name;
      pane.stage.setAttribute("aria-label", name);
      pane.caption.textContent = this.strings.at(name, this.place_text(which));
    }
    for (const [each, thumbnail] of this.thumbnails) {
      thumbnail.setAttribute("aria-pressed", String(each === slot));
      thumbnail.classList.toggle("other", each === this.other);
    }
    this.beside_button.setAttribute("aria-pressed", String(this.beside));
    this.flip_button.setAttribute("aria-disabled", String(this.other === null));
    this.flip_button.setAttribute("aria-label", this.other === null ? this.strings.flip
      : this.strings.flip_with(this.pictures.get(this.other).name));
    this.spoken.textContent = this.strings.shown_now(this.pictures.get(slot).name);
    this.measure();
    this.follow(first);
  }

  /// Both panes look at the same part of their pictures.
  follow({ stage }) {
    for (const pane of this.panes) {
      if (pane.stage === stage) continue;
      pane.stage.scrollTo(stage.scrollLeft, stage.scrollTop);
      pane.followed = { left: pane.stage.scrollLeft, top: pane.stage.scrollTop };
    }
  }

  zoom_by(step) {
    const before = zooms[this.zoom];
    this.zoom = Math.min(zooms.length - 1, Math.max(0, this.zoom + step));
    const scale = zooms[this.zoom] / before;
    const { stage } = this.panes[0];
    const middle = [stage.scrollLeft + stage.clientWidth / 2, stage.scrollTop + stage.clientHeight / 2];
    this.measure();
    stage.scrollTo(middle[0] * scale - stage.clientWidth / 2, middle[1] * scale - stage.clientHeight / 2);
  }

  measure() {
    for (const [pane, slot] of [[this.panes[0], this.shown], [this.panes[1], this.other]]) {
      if (!this.row.contains(pane.element)) continue;
      fit_to_device_pixels(pane.image, pane.stage, this.pictures.get(slot), zooms[this.zoom]);
    }
    this.closer_button.setAttribute("aria-disabled", String(this.zoom === zooms.length - 1));
    this.further_button.setAttribute("aria-disabled", String(this.zoom === 0));
  }

  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey || this.orbit?.key(event)) return;
    const on_button = event.target.closest("button") !== null;
    const step = (by) => {
      const slots = [...this.pictures.keys()];
      this.choose(slots[(slots.indexOf(this.shown) + by + slots.length) % slots.length]);
    };
    const keys = {
      " ": () => this.flip(),
      "s": () => this.set_beside(!this.beside),
      "+": () => this.zoom_by(1),
      "=": () => this.zoom_by(1),
      "-": () => this.zoom_by(-1),
      PageUp: () => step(-1),
      PageDown: () => step(1),
    };
    const act = keys[event.key] ?? keys[event.key.toLowerCase()];
    if (!act || (event.key === " " && on_button)) return;
    event.preventDefault();
    act();
  }

  make_pannable(stage) {
    let from = null;
    stage.addEventListener("pointerdown", (event) => {
      if (event.pointerType !== "mouse" || event.button !== 0) return;
      from = [event.clientX + stage.scrollLeft, event.clientY + stage.scrollTop];
      stage.setPointerCapture(event.pointerId);
    });
    stage.addEventListener("pointermove", (event) => {
      if (from) stage.scrollTo(from[0] - event.clientX, from[1] - event.clientY);
    });
    stage.addEventListener("pointerup", () => (from = null));
    stage.addEventListener("pointercancel", () => (from = null));
  }
}
