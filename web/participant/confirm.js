// "Best: this. Worst: that. Right?" in the study's own words: a scale read backwards is caught here.

import { h, icon } from "/assets/shared/dom.js";
import { capital } from "./strings.js";

function group(heading, slots, pictures) {
  return h("div", { class: "verdict" }, h("h3", {}, capital(heading)),
    h("ul", { class: "verdict-pictures" }, slots.map((slot) => {
      const picture = pictures.get(slot);
      return h("li", {}, h("img", { src: picture.url, alt: picture.name }),
        h("span", { "aria-hidden": "true" }, picture.letter));
    })));
}

/// Asks before a page is left. `labels` are the study's words for both ends. `turn_round` turns the
/// order; `ends()` returns {most, least} slots, or null where all look the same. Resolves to true when
/// the person agrees.
export function confirm_order({ pictures, labels, strings, ends, turn_round }) {
  return new Promise((resolve) => {
    const body = h("div", { class: "verdicts" });
    const said = h("p", { class: "unseen", role: "status" });
    const fill = () => {
      const found = ends();
      body.replaceChildren(...(found
        ? [group(labels.most, found.most, pictures), group(labels.least, found.least, pictures)]
        : [h("p", {}, strings.confirm_same)]));
    };
    const swap = h("button", { type: "button", class: "quiet", on: { click: () => {
      turn_round();
      fill();
      said.textContent = strings.swapped;
    } } }, icon("swap"), strings.confirm_swap);
    // The heading takes the focus: a focused button at the end would scroll the question out of sight.
    const dialog = h("dialog", { class: "card confirm", "aria-labelledby": "confirm-heading" },
      h("h2", { id: "confirm-heading", tabindex: "-1", autofocus: true }, strings.confirm_heading), body, said,
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
