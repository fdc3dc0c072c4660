// "Most realistic: this. Least: that. Right?" - a scale read backwards is caught here.

import { h, icon } from "/assets/shared/dom.js";

function group(heading, slots, pictures) {
  return h("div", { class: "verdict" }, h("h3", {}, heading),
    h("ul", { class: "verdict-pictures" }, slots.map((slot) => {
      const picture = pictures.get(slot);
      return h("li", {}, h("img", { src: picture.url, alt: picture.name }),
        h("span", { "aria-hidden": "true" }, picture.letter));
    })));
}

/// Asks before a page is left. `turn_round` turns the order; `ends()` answers {most, least} slots, or
/// null where all look the same. Resolves to true when the person agrees.
export function confirm_order({ pictures, strings, ends, turn_round }) {
  return new Promise((resolve) => {
    const body = h("div", { class: "verdicts" });
    const said = h("p", { class: "unseen", role: "status" });
    const fill = () => {
      const found = ends();
      body.replaceChildren(...(found
        ? [group(strings.confirm_most, found.most, pictures), group(strings.confirm_least, found.least, pictures)]
        : [h("p", {}, strings.confirm_same)]));
    };
    const swap = h("button", { type: "button", class: "quiet", on: { click: () => {
      turn_round();
      fill();
      said.textContent = strings.swapped;
    } } }, icon("swap"), strings.confirm_swap);
    const dialog = h("dialog", { class: "card confirm", "aria-labelledby": "confirm-heading" },
      h("h2", { id: "confirm-heading" }, strings.confirm_heading), body, said,
      h("div", { class: "actions" },
        h("button", { type: "button", class: "primary", on: { click: () => dialog.close("yes") } }, strings.confirm_yes),
        ends() ? swap : null,
        h("button", { type: "button", class: "quiet", on: { click: () => dialog.close("no") } }, strings.confirm_no)));
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(dialog.returnValue === "yes");
    });
    fill();
    document.body.append(dialog);
    dialog.showModal();
  });
}
