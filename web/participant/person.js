// One participant: entering, resuming, and what has been answered. The server's state and this
// device's are joined here, so that reload, back and a second tab all find the same answers.

import { ApiError, get, post, put, uuid } from "/assets/shared/http.js";
import { alone, Drafts } from "./storage.js";

/// The judgement in an answer, without what was observed beside it.
const judgement = ({ shelves, digits, all_same, difficulty }) =>
  JSON.stringify([Object.entries(shelves ?? digits ?? {}).sort(), all_same ?? false, difficulty ?? null]);

export class Person {
  constructor(storage, outbox, study, entry) {
    Object.assign(this, { storage, outbox, study, entry });
    this.token = entry.participant;
    this.drafts = new Drafts();
    this.path = `/api/v1/participants/${encodeURIComponent(this.token)}`;
  }

  /// The person who entered the study on this device before, or null. Throws ApiError where the server
  /// cannot be asked.
  static async resume(storage, outbox, study) {
    const known = await storage.get(`person:${study}`);
    if (!known?.token) return null;
    try {
      return new Person(storage, outbox, study, await get(`/api/v1/participants/${encodeURIComponent(known.token)}`));
    } catch (error) {
      if (!(error instanceof ApiError) || error.passing) throw error;
      await storage.forget(`person:${study}`);  // withdrawn, or of a data folder that is no more
      return null;
    }
  }

  /// Enters once, however often the button is pressed, in however many tabs: the id is kept before
  /// the request leaves.
  /// `as` names the person's entry on this device: a preview is kept apart.
  static enter(storage, outbox, study, as, request) {
    return alone(`enter:${as}`, async () => {
      const earlier = await Person.resume(storage, outbox, as);
      if (earlier) return earlier;
      const key = `person:${as}`;
      const enrolment_id = (await storage.get(key))?.enrolment_id ?? uuid();
      await storage.set(key, { enrolment_id });
      const entry = await post(`/api/v1/studies/${encodeURIComponent(study)}/participants`,
        { ...request, enrolment_id });
      await storage.set(key, { enrolment_id, token: entry.participant });
      return new Person(storage, outbox, as, entry);
    });
  }

  get pages() {
    return this.entry.pages;
  }

  key(what, page = "") {
    return `${what}:${this.token}:${page}`;
  }

  async answer_of(page) {
    return (await this.storage.get(this.key("answer", page))) ?? this.pages[page].answer;
  }

  /// The first page without an answer, or the number of pages.
  async first_open() {
    for (let page = 0; page < this.pages.length; ++page) {
      if (!(await this.answer_of(page))) return page;
    }
    return this.pages.length;
  }

  /// What the page shows when it opens: the draft, otherwise the answer given, otherwise nothing.
  async kept(page) {
    const answer = await this.answer_of(page);
    return this.drafts.get(this.key("draft", page)) ?? (answer ? { ...answer, observations: answer } : {});
  }

  save_draft(page, draft) {
    this.drafts.set(this.key("draft", page), draft);
  }

  /// The same judgement again is the same answer; a changed one is a new answer that replaces it.
  async submit(page, answer) {
    const before = await this.answer_of(page);
    if (before && judgement(before) === judgement(answer)) return;
    const body = { answer_id: uuid(), ...answer };
    await this.outbox.push(`${this.path}/pages/${this.pages[page].page}`, body, this.key("answer", page), body);
  }

  /// Answers that the server refused are no answers.
  async reload() {
    await this.storage.forget(this.key("answer"));
    this.entry = await get(this.path);
  }

  /// What the person has reached, as far as the server can be asked.
  async look() {
    try {
      this.entry = await get(this.path);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
    }
  }

  async tell_screen(patches_seen) {
    this.entry = await put(`${this.path}/screen`, { patches_seen });
  }

  async complete(details) {
    this.entry = { ...this.entry, ...(await post(`${this.path}/complete`, details)) };
  }

  async forget() {
    this.drafts.forget(this.key("draft"));
    for (const what of ["answer", "begun", "details"]) await this.storage.forget(this.key(what));
    await this.storage.forget(`person:${this.study}`);
  }
}
