// The template with three ways of giving ranks: written in the page, answered in each way, compared.

import assert from "node:assert/strict";
import path from "node:path";
import { after, before, test } from "node:test";
import { violations } from "./axe.js";
import { launch, Person } from "./person.js";
import { Server } from "./server.js";
import { small_study } from "./study.js";

const id = "digits-or-shelves";
let server;
let browser;
let page;

before(async () => {
  server = await Server.start();
  browser = await launch();
  page = await (await browser.newContext({ viewport: { width: 1440, height: 1000 } })).newPage();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

const screenshot = async (where, name) => process.env.SCREENSHOTS
  && where.screenshot({ path: path.join(process.env.SCREENSHOTS, `${name}.png`), fullPage: true });

test("a study of three arms is written from its template", async () => {
  await page.goto(`${server.base}/lab?token=${server.token}`);
  await page.getByLabel("From a template").selectOption({ label: "Which shadows look real? (digits-or-shelves)" });
  await screenshot(page, "studies");
  await page.getByRole("button", { name: "Write a copy" }).click();
  const text = page.getByLabel("Study file (JSON)");
  await page.getByText("Which way of giving ranks is read the right way round?").waitFor();
  assert.deepEqual(await violations(page), []);
  const study = JSON.parse(await text.inputValue());
  assert.deepEqual(study.arms, [{ id: "one-is-best", widget: "numeric", best_digit: 1 },
    { id: "nine-is-best", widget: "numeric", best_digit: 9 }, { id: "shelves", widget: "shelves" }]);
  // As it is it takes long to draw: fewer and smaller pictures here.
  const { picture, techniques, pages } = small_study("any");
  await text.fill(JSON.stringify({ ...study, picture, techniques, pages }));
  await page.getByRole("button", { name: "Check and store as draft" }).click();
  await page.getByRole("button", { name: "Render the pictures and publish" }).click();
  await page.getByRole("link", { name: new RegExp(`/s/${id}$`) }).waitFor({ timeout: 120_000 });
});

/// Ranks A before B before C on the page shown, in the way that the person got.
async function put_in_order(person, best) {
  if (best === null) return person.answer({ A: 0, B: 1, C: 2 }, "easy to see");
  const digit = { 1: { A: "1", B: "3", C: "8" }, 9: { A: "9", B: "7", C: "2" } }[best];
  for (const letter of ["A", "B", "C"]) await person.page.getByLabel(`Digit for Picture ${letter}`).selectOption(digit[letter]);
  await person.rate("easy to see");
  await person.press("Continue");
  const [most, least] = await person.page.locator(".verdict").allInnerTexts();
  assert.match(most, /most realistic[\s\S]*A/i);
  assert.match(least, /least realistic[\s\S]*C/i);
  return person.press("Yes, continue");
}

const said = {
  1: ["from 1 for “most realistic” to 9 for “least realistic”", "1 is “most realistic”, 9 is “least realistic”."],
  9: ["from 1 for “least realistic” to 9 for “most realistic”", "1 is “least realistic”, 9 is “most realistic”."],
};

test("each of three people gets another way, is told it rightly, and is read rightly", async () => {
  const ways = [];
  for (let each = 0; each < 3; ++each) {
    const person = await Person.arrive(browser, server, id);
    const entering = person.page.waitForResponse((reply) => reply.request().method() === "POST" && reply.url().endsWith("/participants"));
    await person.press("I agree and want to take part");
    const { widget, best_digit } = await (await entering).json();
    ways.push(`${widget} ${best_digit}`);
    await person.button("Show the first page").waitFor();
    if (best_digit) await person.page.getByText(said[best_digit][0]).waitFor();
    await person.press("Show the first page");
    for (const position of [0, 1]) {
      await person.see_page(position);
      if (best_digit) await person.page.getByText(said[best_digit][1]).waitFor();
      assert.deepEqual(await violations(person.page), []);
      if (position === 0) await screenshot(person.page, `arm-${best_digit}`);
      await put_in_order(person, best_digit);
    }
    assert.equal(await person.completion_code(), "DIGITS-OR-SHELVES");
    assert.deepEqual(person.faults, []);
    await person.context.close();
  }
  assert.deepEqual(ways.sort(), ["numeric 1", "numeric 9", "shelves null"]);
  const rows = await server.responses(id);
  assert.equal(rows.length, 3 * 2 * 3);
  for (const row of rows) {
    assert.equal(Number(row.rank_1_is_most_realistic), Number(row.slot) + 1, `${row.arm} ${row.digit_as_typed}`);
  }
  assert.deepEqual([...new Set(rows.map((row) => row.arm))].sort(), ["nine-is-best", "one-is-best", "shelves"]);
});

test("where 9 is best, digits typed backwards are turned before they are sent", async () => {
  await server.publish(small_study("nine", { pages: [{ scene: "half-plane" }], widget: "numeric", best_digit: 9,
    practice: { scene: "boxes", techniques: ["reference", "none"] } }));
  const person = await Person.arrive(browser, server, "nine");
  const entering = person.page.waitForResponse((reply) => reply.request().method() === "POST" && reply.url().endsWith("/participants"));
  await person.enter();
  const order = (await (await entering).json()).pages[0].right_order;
  // The practice page takes 9 for the best, too.
  const best = order[0] === 0 ? "A" : "B";
  await person.page.getByLabel(`Digit for Picture ${best}`).selectOption("9");
  await person.page.getByLabel(`Digit for Picture ${best === "A" ? "B" : "A"}`).selectOption("2");
  await person.confirm();
  await person.page.getByRole("heading", { name: "That is the order that is meant" }).waitFor();
  await person.press("Continue");
  await person.see_page(1);
  const digits = { A: "1", B: "5", C: "8" };
  for (const letter of ["A", "B", "C"]) await person.page.getByLabel(`Digit for Picture ${letter}`).selectOption(digits[letter]);
  await person.rate("easy");
  await person.press("Continue");
  const most = person.page.locator(".verdict").first().locator("li");
  assert.equal((await most.innerText()).trim(), "C");
  await person.press("It is the other way round");
  assert.equal((await most.innerText()).trim(), "A");
  await person.press("Yes, continue");
  await person.completion_code();
  const rows = await server.responses("nine");
  assert.deepEqual(rows.map((row) => [row.slot, row.digit_as_typed, row.rank_1_is_most_realistic, row.arm]),
    [["0", "9", "1", ""], ["1", "5", "2", ""], ["2", "2", "3", ""]]);
  await person.context.close();
});

test("the researcher sees people by arm, and the arms compared", async () => {
  await page.goto(`${server.base}/lab#study/${id}`);
  const arms = page.getByRole("table", { name: "People by arm" });
  await arms.waitFor();
  // Text content: the page may put a newer table in place of this one, and what is no longer shown has no laid-out text.
  assert.deepEqual(await arms.locator("tbody th").allTextContents(), ["one-is-best", "nine-is-best", "shelves"]);
  await page.getByRole("heading", { name: "Ways of giving ranks" }).waitFor();
  const compared = page.getByRole("table", { name: "Arms", exact: true });
  for (const arm of [1, 2, 3]) {
    const cells = await compared.locator(`tbody tr:nth-child(${arm}) td`).allTextContents();
    assert.deepEqual(cells.slice(0, 3), ["1", "0", "100%"]);
  }
  assert.deepEqual(await violations(page), []);
  await screenshot(page, "arms");
  await page.goto(`${server.base}/lab#people/${id}/1`);
  await page.getByText("nine-is-best").first().waitFor();
  assert.deepEqual(await violations(page), []);
});
