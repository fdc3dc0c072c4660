// After the practice page: the order that is meant beside the one given. Nothing of it is counted.

import { h } from "/assets/shared/dom.js";
import { from_best } from "./numeric.js";

/// Whether no two pictures are the wrong way round, and the best is before the worst. `places`
/// has a number per slot, the lowest is most realistic.
export function is_right(right_order, places) {
  const given = right_order.map((slot) => places[slot]);
  return given.every((place, index) => index === 0 || given[index - 1] <= place) && given[0] < given.at(-1);
}

/// `again()` returns to the practice page, `go_on()` leaves it.
export function practice_view({ page, pictures, answer, best_digit, strings, labels, again, go_on }) {
  const right = is_right(page.right_order, answer.shelves ?? from_best(answer.digits, best_digit));
  return h("article", { class: "card practised" },
    h("h1", { tabindex: "-1" }, right ? strings.practice_right : strings.practice_wrong),
    h("p", {}, strings.practice_meant(labels.most, labels.least)),
    h("ol", { class: "meant" }, page.right_order.map((slot) => h("li", {},
      h("img", { src: page.images.find((image) => image.slot === slot).url, alt: "" }),
      h("span", {}, pictures.get(String(slot)).name)))),
    h("p", {}, strings.practice_survey),
    h("div", { class: "actions" },
      h("button", { type: "button", class: "primary", on: { click: go_on } }, strings.next),
      h("button", { type: "button", class: "quiet", on: { click: again } }, strings.practice_again)));
}
