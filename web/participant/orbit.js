// Pictures that can be turned: all of a page together, always to the same view.

import { h } from "/assets/shared/dom.js";

/// An image of a picture that turns with its page, wherever it is.
export const turning_image = (picture, attributes) => h("img", { src: picture.url, data: { turns: picture.slot },
  // A view that was loaded comes up at once, without a moment in which there is none.
  decoding: picture.frames ? "sync" : null, ...attributes });

export class Orbit {
  /// `pictures` with `frames`, the addresses of their views, and `url`, the one to begin with.
  /// `on_turn(view)` is told each view that comes up.
  constructor({ pictures, strings, on_turn }) {
    Object.assign(this, { strings, on_turn });
    this.pictures = new Map(pictures.map((picture) => [picture.slot, picture]));
    const [{ frames, url }] = pictures;
    this.count = frames.length;
    this.view = frames.indexOf(url);
    this.middle = this.view;
    this.sliders = [];
  }

  /// A slider; all that were made move together.
  control() {
    const slider = h("input", { type: "range", min: "0", max: String(this.count - 1), step: "1",
      on: { input: () => this.turn_to(Number(slider.value)) } });
    this.sliders.push(slider);
    this.follow();
    return h("label", { class: "turn" }, h("span", {}, this.strings.turn), slider);
  }

  follow() {
    for (const slider of this.sliders) {
      slider.value = String(this.view);
      slider.setAttribute("aria-valuetext", this.strings.view(this.view - this.middle));
    }
  }

  turn_by(step) {
    this.turn_to(Math.min(this.count - 1, Math.max(0, this.view + step)));
  }

  turn_to(view) {
    if (view === this.view) return;
    this.view = view;
    for (const picture of this.pictures.values()) picture.url = picture.frames[view];
    for (const image of document.querySelectorAll("img[data-turns]")) {
      const picture = this.pictures.get(image.dataset.turns);
      if (picture) image.src = picture.url;
    }
    this.follow();
    this.on_turn(view);
  }

  /// Comma and full stop turn by one view. Says whether the key was one of them.
  key(event) {
    const step = { ",": -1, ".": 1 }[event.key];
    if (!step) return false;
    event.preventDefault();
    this.turn_by(step);
    return true;
  }
}
