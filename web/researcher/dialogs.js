// Questions that come before something that others notice.

import { h } from "/assets/shared/dom.js";

let opened = 0;

/// Asks before an action. Resolves to null where it is called off, otherwise to the reason given, or
/// an empty text where none is asked for.
export function ask({ title, text, action, reason = null, danger = false }) {
  return new Promise((done) => {
    const heading = `ask-${++opened}`;
    const field = reason === null ? null : h("textarea", { id: `${heading}-reason`, rows: "3", maxlength: "1000", required: true });
    const dialog = h("dialog", { class: "ask", "aria-labelledby": heading },
      h("form", { method: "dialog", on: { submit: () => dialog.close(field ? `+${field.value.trim()}` : "+") } },
        h("h2", { id: heading }, title), h("p", {}, text),
        field ? [h("label", { for: field.id }, reason), field] : null,
        h("div", { class: "actions" },
          h("button", { type: "submit", class: danger ? "primary danger" : "primary" }, action),
          h("button", { type: "button", class: "quiet", on: { click: () => dialog.close("") } }, "Cancel"))));
    dialog.addEventListener("close", () => {
      dialog.remove();
      done(dialog.returnValue.startsWith("+") ? dialog.returnValue.slice(1) : null);
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}
