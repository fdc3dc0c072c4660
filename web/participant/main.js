// The course of a survey: consent, how it works, the pages, the codes.

import { h, icon, show } from "/assets/shared/dom.js";
import { ApiError, get } from "/assets/shared/http.js";
import { demographics_view, end_view, full_view, over_view } from "./end.js";
import { Outbox } from "./outbox.js";
import { RankingPage } from "./page.js";
import { Person } from "./person.js";
import { practice_view } from "./practice.js";
import { load_ahead, load_pictures } from "./pictures.js";
import { open_storage } from "./storage.js";
import { reason_of, strings_of } from "./strings.js";
import { texts_of } from "./texts.js";
import { consent_view, instruction_view, loading_view, message_view } from "./welcome.js";

const phone_px = 600;  // shorter side of a screen, CSS pixels, below which a touch screen is a phone's
const toast_ms = 3500;

const study = decodeURIComponent(location.pathname.split("/").filter(Boolean).at(-1));
const query = new URLSearchParams(location.search);
const preview = Number(query.get("preview")) || null;  // the version that a researcher looks at
const entry_name = preview ? `${study}@${preview}` : study;
const main = document.getElementById("main");
const bar = document.getElementById("bar");
const live = document.getElementById("live");

class Course {
  async begin() {
    this.storage = await open_storage();
    this.outbox = new Outbox(this.storage);
    this.outbox.addEventListener("change", () => this.outbox_changed());
    this.use_language(navigator.language?.split("-")[0] ?? "en");
    await this.attempt(async () => {
      this.welcome = await get(`/s/${encodeURIComponent(study)}/welcome${preview ? `?version=${preview}` : ""}`);
      const wanted = navigator.languages?.map((tag) => tag.split("-")[0]) ?? [];
      this.use_language(wanted.find((tag) => this.welcome.languages.includes(tag)) ?? this.welcome.languages[0]);
      this.person = await Person.resume(this.storage, this.outbox, entry_name);
      if (this.person) await this.go_on(history.state?.page ?? null);
      else this.show_consent();
    });
    addEventListener("popstate", (event) => this.person && this.attempt(() => this.go_on(event.state?.page ?? null)));
    addEventListener("resize", () => this.check_window());
  }

  use_language(language) {
    this.language = language;
    this.strings = strings_of(language);
    document.documentElement.lang = language;
    if (this.welcome) document.title = this.texts.title;
  }

  get texts() {
    return texts_of(this.welcome, this.language);
  }

  /// Runs a step; where the server cannot be reached, says so and offers the same step again.
  async attempt(step) {
    try {
      await step();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      const text = error.status === 404 ? this.strings.no_study : reason_of(error, this.strings);
      this.show(message_view(text, { name: this.strings.try_again, act: () => this.attempt(step) }));
    }
  }

  /// `judging` keeps the grey around the pictures while they are fetched: a bright field between two
  /// pages would make the shadows after it look darker.
  show(view, { page = null, judging = page !== null } = {}) {
    this.current?.hide();
    this.current = page;
    document.body.classList.toggle("judging", judging);
    show(main, view);
    this.draw_bar();
    this.check_window();
  }

  announce(text, visible = false) {
    live.textContent = "";
    live.textContent = text;
    live.classList.toggle("toast", visible);
    live.classList.toggle("unseen", !visible);
    clearTimeout(this.toast);
    if (visible) this.toast = setTimeout(() => this.announce(""), toast_ms);
  }

  show_consent() {
    if (this.welcome.status !== "open" && !preview) {
      this.show(message_view(this.strings.errors["conflict study"]));
      return;
    }
    if (this.welcome.full && !preview) {
      this.show(full_view(this.welcome, this.strings));
      return;
    }
    const { welcome, language } = this;
    this.show(consent_view({ welcome, language, texts: this.texts, agree: () => this.enter(),
      choose: (chosen) => {
        this.use_language(chosen);
        this.show_consent();
      } }));
  }

  async enter() {
    const parameters = Object.fromEntries(this.welcome.id_parameters
      .filter((name) => query.has(name)).map((name) => [name, query.get(name).slice(0, 200)]));
    this.person = await Person.enter(this.storage, this.outbox, study, entry_name,
      { language: this.language, consent_version: this.welcome.consent_version, parameters,
        ...(preview ? { preview: true, version: preview } : {}) });
    await this.go_on(null);
  }

  /// Shows `wanted` if it may be shown yet, otherwise what the person has reached.
  async go_on(wanted) {
    const { person } = this;
    this.use_language(person.entry.language);
    const sent = this.outbox.flush().catch(() => {});
    if (person.entry.checks_end) {
      await sent;
      await person.look();
    }
    if (this.show_if_ended()) return;
    const open = await person.first_open();
    this.answered = open > 0;
    const begun = await this.storage.get(person.key("begun"));
    if (!begun && open === 0) this.show_instructions();
    else if (wanted !== null && wanted <= open && wanted < person.pages.length) await this.show_page(wanted);
    else if (open < person.pages.length) await this.show_page(open);
    else await this.finish();
  }

  /// Shows how taking part ended, where it did.
  show_if_ended() {
    const { status } = this.person.entry;
    if (status === "started") return false;
    if (status === "over") this.show(over_view(this.person.entry, this.strings));
    else this.show_end();
    return true;
  }

  details() {
    return this.storage.get(this.person.key("details")).then((details) => details ?? {});
  }

  async keep_details(more) {
    await this.storage.set(this.person.key("details"), { ...(await this.details()), ...more });
  }

  show_instructions() {
    load_ahead(this.person.pages[0]);
    this.show(instruction_view({ texts: this.texts, strings: this.strings, widget: this.person.entry.widget, best_digit: this.person.entry.best_digit,
      code: this.person.entry.withdrawal_code,
      count: (seen) => this.keep_details({ patches_seen: seen ?? undefined }),
      begin: async () => {
        const { patches_seen } = await this.details();
        await this.attempt(async () => {
          if (patches_seen !== undefined) await this.person.tell_screen(patches_seen);
          await this.storage.set(this.person.key("begun"), true);
          if (!this.show_if_ended()) await this.show_page(0);
        });
      } }));
  }

  async show_page(number) {
    const { person, strings } = this;
    const page = person.pages[number];
    if (history.state?.page !== number) {
      const step = history.state?.page === undefined ? "replaceState" : "pushState";
      history[step]({ page: number }, "");
    }
    this.at = number;
    const kept = await person.kept(number);
    const pictures = await this.pictures_of(page, number, kept);
    if (this.at !== number) return;  // the person went elsewhere meanwhile
    const view = new RankingPage({ page, pictures, kept, strings, texts: this.texts, widget: person.entry.widget,
      best_digit: person.entry.best_digit,
      announce: (text, visible) => this.announce(text, visible),
      save: (draft) => person.save_draft(number, draft),
      submit: async (answer) => {
        await person.submit(number, answer);
        if (page.right_order) await this.show_practised(page, pictures, answer);
        await this.attempt(() => (number + 1 < person.pages.length ? this.go_on(number + 1) : this.go_on(null)));
      },
      back: number > 0 ? () => history.back() : null });
    this.show(view.element, { page: view });
    view.show();
    load_ahead(person.pages[number + 1]);
    await person.look();
    this.draw_bar();
  }

  /// What was meant on the practice page; the promise ends when the person goes on.
  show_practised(page, pictures, answer) {
    return new Promise((go_on) => {
      this.show(practice_view({ page, pictures, answer, best_digit: this.person.entry.best_digit, strings: this.strings, labels: this.texts.labels, go_on,
        again: () => this.attempt(() => this.show_page(this.at)) }));
    });
  }

  /// Asks again until every picture is there; each failure is counted with the page's answer.
  async pictures_of(page, number, kept) {
    for (;;) {
      const loading = loading_view(this.strings);
      this.show(loading.element, { judging: true });
      try {
        return await load_pictures(page, this.strings, loading.progress);
      } catch {
        const earlier = kept.observations ?? {};
        kept.observations = { ...earlier, load_failures: (earlier.load_failures ?? 0) + 1 };
        this.person.save_draft(number, kept);
        await new Promise((again) => this.show(
          message_view(this.strings.pictures_failed, { name: this.strings.try_again, act: again }), { judging: true }));
      }
    }
  }

  async finish() {
    const { person, strings } = this;
    const questions = this.texts.demographics;
    const details = await this.details();
    if (questions.length && !details.demographics) {
      this.show(demographics_view({ questions, strings, done: async (demographics) => {
        await this.keep_details({ demographics });
        await this.finish();
      } }));
      return;
    }
    this.show(h("p", { class: "loading", role: "status" }, strings.finishing));
    await this.attempt(async () => {
      try {
        await this.outbox.flush();
      } catch {
        return;  // refused: outbox_changed shows the page concerned
      }
      await person.complete(JSON.parse(JSON.stringify(details)));
      this.show_end();
    });
  }

  show_end() {
    const { person } = this;
    this.show(end_view({ entry: person.entry, screened_out: person.entry.status === "screened_out", strings: this.strings, thanks: this.texts.thanks, forget: () => person.forget() }));
  }

  outbox_changed() {
    this.draw_bar();
    if (this.outbox.state !== "refused") return;
    const { refusal } = this.outbox;
    this.attempt(async () => {
      if (refusal.status === 404) {
        this.show(message_view(this.strings.gone));
        return;
      }
      await this.person.reload();
      await this.go_on(null);
      this.announce(this.strings.refused(reason_of(refusal, this.strings)), true);
    });
  }

  draw_bar() {
    const pages = this.person?.pages ?? [];
    const on_page = this.current !== null && this.current !== undefined;
    const { state } = this.outbox;
    const told = this.person && (state !== "saved" || this.answered);
    const text = told && { saved: this.strings.saved, sending: this.strings.sending, waiting: this.strings.waiting_short }[state];
    bar.replaceChildren(
      h("span", { class: "bar-title" }, this.welcome ? this.texts.title : ""),
      on_page ? h("div", { class: "progress", role: "img", "aria-label": this.strings.page_of(this.at + 1, pages.length) },
        pages.map((_, index) => h("span", { class: index < this.at ? "done" : index === this.at ? "now" : "" }))) : "",
      preview ? h("span", { class: "closing" }, this.strings.preview) : "",
      this.person?.entry.closes_at && on_page
        ? h("span", { class: "closing", role: "status" }, this.strings.closes(new Date(this.person.entry.closes_at))) : "",
      text ? h("span", { class: `save ${state}`, role: "status", title: state === "waiting" ? this.strings.waiting : "" },
        state === "saved" ? icon("check") : h("span", { class: "dot" }), text) : "");
    document.body.classList.toggle("offline", state === "waiting");
  }

  /// Says what the study demands of the screen while it is not met; nothing is lost meanwhile.
  check_window() {
    const needed = this.welcome?.minimum_window;
    const small = needed && (innerWidth < needed.width || innerHeight < needed.height);
    const phone = this.welcome && !this.welcome.phones_allowed && matchMedia("(pointer: coarse)").matches
      && Math.min(screen.width, screen.height) < phone_px;
    const gate = document.getElementById("gate");
    gate?.remove();
    main.hidden = Boolean(small || phone);
    if (!main.hidden) return;
    const text = phone ? this.strings.phone : this.strings.window(needed.width, needed.height);
    main.before(h("section", { id: "gate", role: "status" }, h("p", { class: "card message" }, text)));
  }
}

await new Course().begin();
