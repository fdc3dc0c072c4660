// One page of the survey: its pictures, the order given to them, and how hard that was.

import { h } from "/assets/shared/dom.js";
import { Arrangement } from "./arrangement.js";
import { Board } from "./board.js";
import { confirm_order } from "./confirm.js";
import { DigitBoard } from "./numeric.js";
import { Observations } from "./observations.js";
import { Orbit, turning_image } from "./orbit.js";
import { Viewer } from "./viewer.js";

const reference_slot = "reference";  // in the viewer, beside the slots of the pictures to rank

export class RankingPage {
  /// `page` as the server describes it, `pictures` loaded; `kept` is what a reload or an earlier
  /// visit left: {shelves|digits, all_same, difficulty, observations}.
  constructor({ page, pictures, texts, strings, widget, best_digit, kept, announce, save, submit, back }) {
    Object.assign(this, { page, pictures, texts, strings, announce, save, submit, back });
    this.practice = page.kind === "practice";
    this.observations = new Observations(kept.observations);
    const shared = { pictures, strings, labels: texts.labels,
      on_change: () => this.changed(), on_enlarge: (slot) => this.enlarge(slot) };
    if (widget === "numeric") {
      this.digits = new DigitBoard({ ...shared, digits: kept.digits ?? {}, best: best_digit });
    } else {
      this.arrangement = new Arrangement([...pictures.keys()], kept.shelves, kept.all_same ?? false);
      this.board = new Board({ ...shared, arrangement: this.arrangement, announce });
    }
    if (page.reference) Object.assign(page.reference, { slot: reference_slot, letter: strings.reference_short, name: strings.reference });
    if (page.images[0].frames) this.orbit = this.make_orbit();
    this.element = this.make(kept.difficulty ?? null);
    this.follow();
  }

  make_orbit() {
    const { page, pictures, strings } = this;
    const orbit = new Orbit({ pictures: [...pictures.values(), page.reference].filter(Boolean), strings,
      on_turn: (view) => {
        this.observations.see(view);
        this.note("turns");
      } });
    this.observations.see(orbit.view);
    return orbit;
  }

  make(difficulty) {
    const { strings, texts } = this;
    this.problems = h("div", { class: "problems", role: "alert" });
    this.same = h("input", { type: "checkbox", id: "all-same", on: { change: () => {
      this.arrangement.all_same = this.same.checked;
      this.changed();
    } } });
    if (this.arrangement) this.same.checked = this.arrangement.all_same;
    const same = this.arrangement
      ? h("label", { class: "choice same", for: "all-same" }, this.same, h("span", {}, strings.all_same)) : null;
    this.difficulty = h("fieldset", { class: "difficulty" },
      h("legend", {}, texts.difficulty.question),
      h("div", { class: "steps" }, texts.difficulty.labels.map((label, index) => h("label", { class: "step" },
        h("input", { type: "radio", name: "difficulty", value: String(index + 1),
          checked: difficulty === index + 1, on: { change: () => this.changed() } }),
        h("span", {}, label)))));
    const finish = h("section", { class: "finish" },
      this.difficulty, this.problems,
      h("div", { class: "actions" }, same,
        this.back ? h("button", { type: "button", class: "quiet", on: { click: this.back } }, strings.back) : null,
        h("button", { type: "button", class: "primary next", on: { click: () => this.leave() } }, strings.next)));
    const question = h("div", { class: "question" },
      this.practice ? h("p", { class: "practice" }, h("strong", {}, strings.practice), ` ${strings.practice_text}`) : null,
      h("h1", { tabindex: "-1" }, this.page.question), this.orbit?.control(),
      this.digits ? null : h("details", { class: "ways" }, h("summary", {}, strings.how_heading), h("p", {}, strings.how_ways)));
    const reference = this.make_reference();
    this.work = h("div", { class: `work ${this.digits ? "typed" : "shelved"}` },
      this.digits ? [reference, this.digits.element]
        : [h("div", { class: "tray-place" }, reference, this.board.tray),
          h("p", { class: "keys", "aria-hidden": "true" }, strings.board_keys, this.orbit ? ` · ${strings.turn_keys}` : ""), this.board.rack, this.board.glance.element], finish);
    const stage = h("div", { class: "stage" }, question, this.work);
    stage.classList.toggle("shelving", !this.digits);
    stage.addEventListener("keydown", (event) => this.key(event));
    return stage;
  }

  /// The true picture, where the study shows it beside the others.
  make_reference() {
    const { page, strings } = this;
    if (!page.reference) return null;
    this.reference_image = turning_image(page.reference, { alt: strings.enlarge(strings.reference) });
    const button = h("button", { type: "button", class: "pick", on: { click: () => this.enlarge(reference_slot) } }, this.reference_image);
    this.board?.glance.attach(button, () => strings.reference);
    return h("figure", { class: "true-picture" }, button, h("figcaption", {}, strings.reference));
  }

  /// One key leads through the page: every picture to place, then the last question.
  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey || this.orbit?.key(event)) return;
    if (!this.board || event.key.toLowerCase() !== "n") return;
    event.preventDefault();
    if (!this.board.focus_next()) this.focus_difficulty();
  }

  focus_difficulty() {
    (this.difficulty.querySelector("input:checked") ?? this.difficulty.querySelector("input")).focus();
  }

  get chosen_difficulty() {
    const checked = this.difficulty.querySelector("input:checked");
    return checked ? Number(checked.value) : null;
  }

  enlarge(slot) {
    const pictures = new Map(this.pictures);
    if (this.page.reference) {
      pictures.set(reference_slot, Object.assign(this.page.reference,
        { width: this.reference_image.naturalWidth, height: this.reference_image.naturalHeight }));
    }
    this.board?.glance.withdraw();
    this.viewer = new Viewer({ pictures, strings: this.strings, orbit: this.orbit,
      shelf_of: (which) => this.arrangement?.shelf_of(which) ?? null, lowest: this.pictures.size - 1,
      place_text: (which) => (this.board && which !== reference_slot ? this.board.shelf_text(this.arrangement.shelf_of(which)) : ""),
      on_flip: () => this.note("flips"), on_show: () => this.note("enlargements") });
    this.viewer.open(slot);
  }

  note(what) {
    this.observations.count(what);
    this.save(this.draft());
  }

  changed() {
    this.follow();
    this.problems.replaceChildren();
    this.difficulty.classList.remove("lacking");
    this.save(this.draft());
  }

  /// The look that goes with the state: shelves rest while "all the same" is chosen.
  follow() {
    if (!this.arrangement) return;
    const { all_same } = this.arrangement;
    this.work.classList.toggle("same", all_same);
    this.board.rack.inert = all_same;
  }

  draft() {
    return {
      ...(this.digits ? { digits: this.digits.answer() }
        : { shelves: this.arrangement.draft(), all_same: this.arrangement.all_same }),
      difficulty: this.chosen_difficulty,
      observations: this.observations.draft(),
    };
  }

  /// What is missing, in the order of the page: [{text, focus}].
  missing() {
    const found = [];
    const names = (slots) => slots.map((slot) => this.pictures.get(slot).name);
    if (this.digits?.missing.length) {
      const slots = this.digits.missing;
      found.push({ text: this.strings.digits_missing(names(slots)), focus: () => this.digits.focus(slots[0]) });
    }
    if (this.arrangement && !this.arrangement.complete) {
      const slots = this.arrangement.unplaced;
      found.push({ text: this.strings.unplaced_missing(names(slots), this.pictures.size), focus: () => this.board.focus(slots[0]) });
    }
    if (!this.practice && this.chosen_difficulty === null) {
      found.push({ text: this.strings.difficulty_missing, focus: () => this.focus_difficulty() });
    }
    return found;
  }

  async leave() {
    const missing = this.missing();
    this.problems.replaceChildren(...(missing.length ? [h("h3", {}, this.strings.missing_heading),
      h("ul", {}, missing.map(({ text, focus }) =>
        h("li", {}, h("button", { type: "button", class: "link", on: { click: focus } }, text))))] : []));
    this.difficulty.classList.toggle("lacking", !this.practice && this.chosen_difficulty === null);
    if (missing.length) {
      missing[0].focus();
      return;
    }
    if (await confirm_order({ pictures: this.pictures, labels: this.texts.labels, strings: this.strings,
      ends: () => this.ends(), turn_round: () => this.turn_round() })) {
      await this.submit(this.answer());
    }
  }

  ends() {
    if (this.digits) return this.digits.ends();
    if (this.arrangement.flat) return null;
    return { most: this.arrangement.most_realistic, least: this.arrangement.least_realistic };
  }

  turn_round() {
    this.observations.count("swaps");
    (this.digits ?? this.arrangement).turn_round();
    this.board?.refresh();
    this.changed();
  }

  /// The answer without its id.
  answer() {
    const difficulty = this.chosen_difficulty;
    return {
      ...(this.digits ? { digits: this.digits.answer() }
        : { shelves: this.arrangement.answer(), all_same: this.arrangement.all_same }),
      ...(difficulty === null ? {} : { difficulty }),
      order_shown: this.page.images.map(({ slot }) => slot),
      ...this.observations.answer(),
    };
  }

  show() {
    this.observations.start();
  }

  hide() {
    this.observations.stop();
    this.viewer?.dialog.close();
    this.save(this.draft());
  }
}
