// After the last page: questions about the person, the codes, and the way to have answers deleted.

import { h, icon, paragraphs } from "/assets/shared/dom.js";
import { ApiError, remove } from "/assets/shared/http.js";

/// Asked once, after the pages, so that they cannot colour the answers. `done(answers)`.
export function demographics_view({ questions, strings, done }) {
  const problem = h("p", { class: "problems", role: "alert" });
  const fields = questions.map((question) => ({ question, field: h("fieldset", { class: "choices" },
    h("legend", {}, question.question, question.required ? null : h("small", {}, ` (${strings.optional})`)),
    question.options.map((option) => h("label", { class: "choice" },
      h("input", { type: "radio", name: `about-${question.id}`, value: option.id }), h("span", {}, option.text)))) }));
  const send = () => {
    const answers = {};
    for (const { question, field } of fields) {
      const value = field.querySelector("input:checked")?.value;
      if (value !== undefined) {
        answers[question.id] = value;
      } else if (question.required) {
        problem.textContent = `${strings.missing_heading}: ${question.question}`;
        field.querySelector("input").focus();
        return;
      }
    }
    done(answers);
  };
  return h("article", { class: "card" }, h("h1", { tabindex: "-1" }, strings.demographics_heading),
    fields.map(({ field }) => field), problem,
    h("div", { class: "actions" }, h("button", { type: "button", class: "primary", on: { click: send } }, strings.next)));
}

function code_box(heading, code, strings, ...more) {
  const copy = h("button", { type: "button", class: "quiet", on: { click: async () => {
    await navigator.clipboard.writeText(code);
    copy.lastChild.textContent = strings.copied;
  } } }, icon("copy"), h("span", { role: "status" }, strings.copy));
  const selectable = h("code", { class: "code", tabindex: "0" }, code);
  return h("section", { class: "code-box" }, h("h2", {}, heading),
    h("div", { class: "code-line" }, selectable, navigator.clipboard ? copy : null), more);
}

/// The code by which the site that sent the person knows how taking part ended, and the way back.
function completion_box({ completion_code, completion_url }, strings) {
  const link = completion_url ? h("p", {}, h("a", { class: "primary", href: completion_url, rel: "noreferrer" },
    strings.completion_link)) : null;
  return completion_code ? code_box(strings.completion, completion_code, strings, link) : link;
}

/// For those who come when the study has as many people as it needs.
export function full_view(welcome, strings) {
  return h("article", { class: "card end" }, h("h1", { tabindex: "-1" }, strings.errors["conflict quota"]), completion_box(welcome, strings));
}

/// For those whose study was closed before they finished: what is kept, and how to have it deleted.
export function over_view(entry, strings) {
  return h("article", { class: "card end" }, h("h1", { tabindex: "-1" }, strings.over_heading),
    paragraphs(strings.over_kept(entry.answered, entry.pages.length)),
    code_box(strings.withdrawal, entry.withdrawal_code, strings, h("p", {}, strings.withdrawal_text)),
    withdrawal_form(strings));
}

export function end_view({ entry, strings, thanks, forget, screened_out }) {
  return h("article", { class: "card end" }, h("h1", { tabindex: "-1" }, strings.end_heading),
    paragraphs(screened_out ? strings.screened_out : thanks),
    completion_box(entry, strings),
    code_box(strings.withdrawal, entry.withdrawal_code, strings, h("p", {}, strings.withdrawal_text)),
    withdrawal_form(strings, forget));
}

/// Deletes a person's answers by code. `after()` clears what this device kept.
export function withdrawal_form(strings, after = async () => {}) {
  const field = h("input", { id: "withdrawal-code", name: "code", autocomplete: "off", spellcheck: "false", required: true });
  const outcome = h("p", { class: "outcome", role: "status" });
  const form = h("form", { on: { submit: async (event) => {
    event.preventDefault();
    try {
      await remove(`/api/v1/withdrawals/${encodeURIComponent(field.value.trim())}`);
      await after();
      outcome.textContent = strings.withdrawn;
    } catch (error) {
      outcome.textContent = !(error instanceof ApiError) || error.passing ? strings.unreachable : strings.withdraw_unknown;
    }
  } } },
  h("p", {}, strings.withdraw_text),
  h("label", { for: "withdrawal-code" }, strings.withdraw_code),
  h("div", { class: "field-line" }, field, h("button", { type: "submit", class: "quiet danger" }, strings.withdraw)),
  outcome);
  return h("details", { class: "withdrawal" }, h("summary", {}, strings.withdraw_heading), form);
}
