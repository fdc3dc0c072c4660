// Before the first page: what this is about, consent, how it works, and a look at the screen.

import { h, paragraphs } from "/assets/shared/dom.js";
import { languages, reason_of, strings_of } from "./strings.js";
import { withdrawal_form } from "./end.js";
import { digit_ends } from "./numeric.js";

function language_choice(welcome, language, strings, choose) {
  if (welcome.languages.length < 2) return null;
  return h("div", { class: "languages", role: "group", "aria-label": strings.choose_language },
    welcome.languages.map((each) => h("button", {
      type: "button", lang: each, class: "quiet", "aria-pressed": String(each === language),
      on: { click: () => choose(each) },
    }, languages[each]?.language ?? each)));
}

/// Title, introduction and consent. `agree()` enters; `choose(language)` shows it in another one.
export function consent_view({ welcome, language, texts, agree, choose }) {
  const strings = strings_of(language);
  const problem = h("p", { class: "problems", role: "alert" });
  const start = h("button", { type: "button", class: "primary", on: { click: async () => {
    start.disabled = true;
    problem.textContent = "";
    try {
      await agree();
    } catch (error) {
      if (error.field === "consent_version") location.reload();  // agreed to a text that has changed since
      problem.textContent = reason_of(error, strings);
    }
    start.disabled = false;
  } } }, strings.start);
  return h("article", { class: "card" },
    language_choice(welcome, language, strings, choose),
    h("h1", { tabindex: "-1" }, texts.title), paragraphs(texts.introduction),
    h("section", { class: "consent", "aria-labelledby": "consent-heading" },
      h("h2", { id: "consent-heading" }, strings.consent_heading), paragraphs(texts.consent),
      h("details", { class: "kept" }, h("summary", {}, strings.kept_heading),
        h("ul", {}, strings.kept(welcome.id_parameters).map((item) => h("li", {}, item))))),
    problem, h("div", { class: "actions" }, start),
    withdrawal_form(strings));
}

const patch_levels = [8, 12, 16, 20, 26, 32, 40, 50];  // sRGB 0..255 on black: the shadows' end of the scale

function patches(strings, count) {
  const answer = h("select", { id: "patches-seen" },
    h("option", { value: "" }, "–"),
    Array.from({ length: patch_levels.length + 1 }, (_, seen) => h("option", { value: String(seen) }, String(seen))));
  answer.addEventListener("change", () => count(answer.value === "" ? null : Number(answer.value)));
  return h("section", { class: "screen", "aria-labelledby": "screen-heading" },
    h("h2", { id: "screen-heading" }, strings.screen_heading), h("p", {}, strings.screen_text),
    h("div", { class: "patches", role: "img", "aria-label": strings.screen_patches }, patch_levels.map((level) => {
      const patch = h("span");
      patch.style.backgroundColor = `rgb(${level} ${level} ${level})`;
      return patch;
    })),
    h("p", {}, h("label", { for: "patches-seen" }, strings.patches_seen), " ", answer));
}

/// How to do it. `begin()` shows the first page, `count(seen)` keeps the number of patches told apart.
export function instruction_view({ texts, strings, widget, best_digit, code, begin, count }) {
  const numeric = widget === "numeric";
  const { most, least } = texts.labels;
  const rank = numeric ? strings.how_digits(...digit_ends(texts.labels, best_digit)) : strings.how_shelves(most, least);
  const steps = [strings.how_look, rank, strings.how_closer];
  return h("article", { class: "card" },
    h("h1", { tabindex: "-1" }, strings.how_heading),
    h("ol", { class: "how" }, steps.map(([name, text]) => h("li", {}, h("h2", {}, name), h("p", {}, text)))),
    numeric ? null : h("p", { class: "small" }, strings.how_ways),
    patches(strings, count),
    h("p", { class: "small" }, `${strings.withdrawal}: `, h("code", {}, code), `. ${strings.withdrawal_text}`),
    h("div", { class: "actions" }, h("button", { type: "button", class: "primary", on: { click: begin } }, strings.begin)));
}

/// What is seen while pictures are fetched. `progress(done, total)` moves its bar.
export function loading_view(strings) {
  const bar = h("progress", { max: "1", value: "0", "aria-labelledby": "loading" });
  const count = h("p", { "aria-hidden": "true" });
  return {
    element: h("div", { class: "loading" }, h("p", { id: "loading", role: "status" }, strings.pictures_loading), bar, count),
    progress: (done, total) => {
      bar.max = total;
      bar.value = done;
      count.textContent = strings.pictures_loaded(done, total);
    },
  };
}

/// A single message, with a way on where there is one.
export function message_view(text, action = null) {
  return h("article", { class: "card message" }, h("h1", { tabindex: "-1" }, text),
    action ? h("div", { class: "actions" },
      h("button", { type: "button", class: "primary", on: { click: action.act } }, action.name)) : null);
}
