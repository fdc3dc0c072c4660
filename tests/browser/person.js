// A participant in headless Chromium: what a person sees and does, in a person's words.

import { chromium } from "playwright-core";

const flags = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];

export const launch = () => chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium-headless-shell", args: flags });

export class Person {
  static async arrive(browser, server, study, options = {}) {
    const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, locale: "en-GB", ...options });
    const person = new Person();
    Object.assign(person, { context, server, study, page: await context.newPage(), faults: [], requests: [] });
    person.page.on("pageerror", (error) => person.faults.push(error.message));
    person.page.on("console", (message) => message.type() === "error" && person.faults.push(message.text()));
    context.on("request", (request) => person.requests.push(request));
    await person.open();
    return person;
  }

  async open() {
    await this.page.goto(`${this.server.base}/s/${this.study}`);
  }

  button(name) {
    return this.page.getByRole("button", { name });
  }

  async press(name) {
    await this.button(name).click();
  }

  async enter() {
    await this.press("I agree and want to take part");
    await this.press("Show the first page");
    await this.see_page(0);
  }

  /// Waits until the pictures of the page at this position are in view.
  async see_page(position) {
    await this.page.locator(`.progress span:nth-child(${position + 1}).now`).waitFor();
    await this.page.locator(".pick img").first().waitFor();
  }

  picture(letter) {
    return this.page.getByRole("button", { name: new RegExp(`^Picture ${letter} ?,`) });
  }

  shelf(index) {
    return this.page.locator(".shelf").nth(index);
  }

  async click_onto(letter, shelf) {
    await this.picture(letter).click();
    await this.shelf(shelf).locator(".place").click();
  }

  /// {letter: shelf or null} as the page shows it.
  arrangement() {
    return this.page.evaluate(() => Object.fromEntries([...document.querySelectorAll(".picture")].map((item) =>
      [item.querySelector("img").alt.at(-1), item.closest(".shelf") ? Number(item.closest(".shelf").dataset.shelf) : null])));
  }

  async rate(difficulty) {
    await this.page.getByRole("radio", { name: difficulty, exact: true }).check();
  }

  async confirm() {
    await this.press("Continue");
    await this.press("Yes, continue");
  }

  /// Places A, B, C by keyboard, rates and leaves the page.
  async answer(shelves, difficulty = "easy") {
    for (const [letter, shelf] of Object.entries(shelves)) {
      await this.picture(letter).focus();
      for (let step = 0; step <= shelf; ++step) await this.page.keyboard.press("ArrowDown");
    }
    await this.rate(difficulty);
    await this.confirm();
  }

  async completion_code() {
    return this.page.locator(".code").first().innerText();
  }
}
