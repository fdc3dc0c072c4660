// Typed ranks, only to repeat the survey of 2007 as it was (van Sambeek 2007, 4.1.2): every picture
// gets a digit, equal ones allowed, kept as typed.

import { h, icon } from "/assets/shared/dom.js";
import { turning_image } from "./orbit.js";

/// The labels of the digits 1 and 9.
export const digit_ends = ({ most, least }, best) => (best === 9 ? [least, most] : [most, least]);

/// Digits by slot, counted from 1 for the end that the study names first.
export const from_best = (digits, best) =>
  Object.fromEntries(Object.entries(digits).map(([slot, digit]) => [slot, best === 9 ? 10 - digit : digit]));

export class DigitBoard {
  /// `best` is the digit, 1 or 9, of the end that the study names first.
  constructor({ pictures, digits, best, labels, strings, on_change, on_enlarge }) {
    this.best = best;
    this.fields = new Map();
    const items = [...pictures.values()].map((picture) => {
      const field = h("select", { "aria-label": strings.digit(picture.name), on: { change: on_change } },
        h("option", { value: "" }, "–"),
        Array.from({ length: 9 }, (_, index) => h("option", { value: String(index + 1) }, String(index + 1))));
      field.value = digits[picture.slot] ? String(digits[picture.slot]) : "";
      this.fields.set(picture.slot, field);
      return h("li", { class: "picture" },
        h("button", { type: "button", class: "pick", "aria-label": strings.enlarge(picture.name),
          on: { click: () => on_enlarge(picture.slot) } },
        turning_image(picture, { alt: "", width: picture.width, height: picture.height })),
        h("div", { class: "caption" }, h("span", { "aria-hidden": "true" }, picture.letter), field, icon("enlarge")));
    });
    this.element = h("section", { class: "digits" },
      h("p", { class: "scale" }, strings.digits_scale(...digit_ends(labels, best))), h("ul", { class: "pictures" }, items));
  }

  get missing() {
    return [...this.fields].filter(([, field]) => field.value === "").map(([slot]) => slot);
  }

  focus(slot) {
    this.fields.get(slot).focus();
  }

  answer() {
    return Object.fromEntries([...this.fields].filter(([, field]) => field.value !== "")
      .map(([slot, field]) => [slot, Number(field.value)]));
  }

  turn_round() {
    for (const field of this.fields.values()) field.value = String(10 - Number(field.value));
  }

  /// Slots at either end, or null where all are equal.
  ends() {
    const digits = [...this.fields].map(([slot, field]) => [slot, Number(field.value)]);
    const values = digits.map(([, digit]) => digit);
    const at = (value) => digits.filter(([, digit]) => digit === value).map(([slot]) => slot);
    const [low, high] = [Math.min(...values), Math.max(...values)];
    if (low === high) return null;
    return this.best === 9 ? { most: at(high), least: at(low) } : { most: at(low), least: at(high) };
  }
}
