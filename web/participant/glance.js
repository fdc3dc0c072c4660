// A picture in actual size for as long as the pointer or the keyboard's focus rests on it, at the far
// side of the window, so that neither the picture nor its neighbours are covered.

import { h } from "/assets/shared/dom.js";

const rest_ms = 350;      // a pointer on its way elsewhere opens nothing
const margin_px = 8;
const worthwhile = 1.25;  // times the width of the picture in its place; less would show nothing new

export class Glance {
  constructor() {
    this.image = h("img", { alt: "" });
    this.caption = h("p", {});
    this.element = h("div", { class: "glance", "aria-hidden": "true", hidden: true }, this.image, this.caption);
  }

  /// Shows `button`'s picture when rested on; `caption()` is what is below it.
  attach(button, caption) {
    const offer = () => this.offer(button, caption);
    const withdraw = () => this.withdraw();
    // Only a pointer that moves: pictures also slide under one that lies still.
    button.addEventListener("pointermove", (event) => {
      if (event.pointerType === "mouse" && event.buttons === 0 && (event.movementX || event.movementY)) offer();
    });
    button.addEventListener("pointerleave", withdraw);
    button.addEventListener("pointerdown", () => {
      withdraw();
      this.of = button;  // a press means something else: no picture until the pointer has left
    });
    button.addEventListener("focus", () => button.matches(":focus-visible") && offer());
    button.addEventListener("blur", withdraw);
    button.addEventListener("keydown", (event) => event.key === "Escape" && withdraw());
  }

  offer(button, caption) {
    if (this.of === button) return;
    this.withdraw();
    this.of = button;
    this.timer = setTimeout(() => this.show(button.querySelector("img"), caption()), rest_ms);
  }

  withdraw() {
    clearTimeout(this.timer);
    this.of = null;
    this.element.hidden = true;
  }

  show(source, caption) {
    const place = source.getBoundingClientRect();
    const on_left = place.left + place.right < innerWidth;
    const room = on_left ? innerWidth - place.right : place.left;
    this.image.dataset.turns = source.dataset.turns;
    this.image.src = source.src;
    this.caption.textContent = caption;
    this.element.hidden = false;
    const height = innerHeight - 2 * margin_px - this.caption.offsetHeight;
    // One device pixel per picture pixel where there is room, otherwise as large as fits.
    const scale = Math.min(1 / devicePixelRatio, (room - 2 * margin_px) / source.naturalWidth, height / source.naturalHeight);
    const width = source.naturalWidth * scale;
    if (width < worthwhile * place.width) {
      this.element.hidden = true;
      return;
    }
    this.image.style.width = `${width}px`;
    this.image.style.height = `${source.naturalHeight * scale}px`;
    const snapped = (length) => Math.round(length * devicePixelRatio) / devicePixelRatio;
    const top = (place.top + place.bottom) / 2 - (source.naturalHeight * scale) / 2;
    const lowest = margin_px + height - source.naturalHeight * scale;
    this.element.style.left = `${snapped(on_left ? innerWidth - margin_px - width : margin_px)}px`;
    this.element.style.top = `${snapped(Math.max(margin_px, Math.min(lowest, top)))}px`;
  }
}
