import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { violations } from "./axe.js";
import { launch, Person } from "./person.js";
import { Server } from "./server.js";
import { small_study } from "./study.js";

const study = "lab";
let server;
let browser;
let page;

before(async () => {
  server = await Server.start();
  await server.call("POST", "/api/v1/studies", small_study(study));
  browser = await launch();
  page = await (await browser.newContext({ viewport: { width: 1440, height: 1000 } })).newPage();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

test("without the token the laboratory stays shut", async () => {
  const context = await browser.newContext();
  const reply = await (await context.newPage()).goto(`${server.base}/lab`);
  assert.equal(reply.status(), 401);
  await context.close();
});

test("a researcher publishes a study, people answer, and the means appear", async () => {
  await page.goto(`${server.base}/lab?token=${server.token}`);
  assert.ok(!page.url().includes(server.token));
  await page.getByRole("heading", { name: "Studies" }).waitFor();
  assert.deepEqual(await violations(page), []);
  await page.locator(".studies .card", { hasText: study }).getByRole("link").click();
  await page.getByRole("button", { name: "Render the pictures and publish" }).click();
  // Whatever the page says in red while pictures are drawn is kept, however short it is there.
  await page.evaluate(() => {
    window.alarms = [];
    new MutationObserver(() => document.querySelectorAll("main .problems:not(:empty)").forEach((problem) =>
      window.alarms.push(problem.textContent))).observe(document.querySelector("main"), { childList: true, subtree: true });
  });
  await page.getByText(/^Rendering the pictures: /).waitFor();
  const link = page.getByRole("link", { name: new RegExp(`/s/${study}$`) });
  await link.waitFor({ timeout: 120_000 });
  assert.equal(await link.getAttribute("href"), `${server.base}/s/${study}`);
  assert.deepEqual(await page.evaluate(() => window.alarms), []);
  for (let each = 0; each < 2; ++each) {
    const person = await Person.arrive(browser, server, study);
    await person.enter();
    await person.answer({ A: 0, B: 1, C: 2 });
    await person.see_page(1);
    await person.answer({ A: 0, B: 1, C: 2 });
    await person.completion_code();
    await person.context.close();
  }
  await page.locator(".figures dd").first().filter({ hasText: /^2$/ }).waitFor();
  await page.locator(".result", { hasText: "All scenes" }).getByText("2 participants").waitFor();
  const results = await server.call("GET", `/api/v1/studies/${study}/results.json`);
  const overall = results.included_sets.all.overall.techniques;
  const shown = await page.locator(".result").first().locator("tbody tr").evaluateAll((rows) =>
    rows.map((row) => [...row.cells].map((cell) => cell.innerText.trim()).filter(Boolean)));
  assert.equal(shown.length, 3);
  for (const [index, technique] of overall.entries()) {
    assert.ok(shown[index].includes(technique.weighted_mean_rank.toFixed(2)), `${shown[index]} has no ${technique.weighted_mean_rank}`);
  }
  assert.deepEqual(await violations(page), []);
});

test("the set of participants that was chosen stays chosen when answers come in", async () => {
  const choice = page.getByLabel("Participants", { exact: true });
  await choice.selectOption("inverted_turned");
  await choice.focus();
  const person = await Person.arrive(browser, server, study);
  await person.enter();
  await person.answer({ A: 0, B: 1, C: 2 });
  await person.see_page(1);
  await person.answer({ A: 0, B: 1, C: 2 });
  await person.completion_code();
  await person.context.close();
  await page.locator(".figures dd").first().filter({ hasText: /^3$/ }).waitFor();
  await page.locator(".result", { hasText: "All scenes" }).getByText("3 participants").waitFor();
  assert.equal(await choice.inputValue(), "inverted_turned");
  assert.ok(await choice.evaluate((element) => element === document.activeElement));
});

test("a closed study lets nobody in", async () => {
  await page.getByRole("button", { name: "Close the study" }).click();
  await page.locator("dialog").getByRole("button", { name: "Close" }).click();
  await page.getByText("Closed", { exact: true }).first().waitFor();
  const person = await Person.arrive(browser, server, study);
  await person.page.getByText("This survey is not open at the moment.").waitFor();
  await person.context.close();
});

test("on the bench a picture stands beside the reference and its error, with numbers", async () => {
  await page.getByRole("link", { name: "Bench" }).click();
  await page.getByLabel("Scene", { exact: true }).selectOption("half-plane");
  await page.getByLabel("Technique", { exact: true }).selectOption("shadow-map");
  // What only another layout reads is left out.
  assert.equal(await page.getByLabel("cascades", { exact: true }).isVisible(), false);
  await page.getByLabel("layout", { exact: true }).selectOption("cascaded");
  assert.equal(await page.getByLabel("cascades", { exact: true }).isVisible(), true);
  await page.getByLabel("layout", { exact: true }).selectOption("single");
  assert.equal(await page.getByLabel("cascades", { exact: true }).isVisible(), false);
  await page.getByLabel("Width and height, pixels").fill("96");
  await page.getByLabel(/^Light samples/).fill("16");
  await page.getByRole("button", { name: "Render" }).click();
  await page.locator(".bench-result figure").nth(2).waitFor({ timeout: 120_000 });
  const sizes = await page.locator(".bench-result img").evaluateAll(async (all) => {
    await Promise.all(all.map((image) => image.decode()));
    return all.map((image) => image.naturalWidth);
  });
  assert.deepEqual(sizes, [96, 96, 96]);
  const error = await page.getByRole("row", { name: /rms_y/ }).locator("td").innerText();
  assert.ok(Number(error) > 0, error);
  assert.match(await page.getByRole("row", { name: /Frame time, median/ }).locator("td").innerText(), /^[\d.]+ ms$/);
  assert.deepEqual(await violations(page), []);
});

test("what the server refuses is said in words at the field concerned", async () => {
  await page.getByLabel("Width and height, pixels").evaluate((field) => (field.max = ""));
  await page.getByLabel("Width and height, pixels").fill("100000");
  await page.getByRole("button", { name: "Render" }).click();
  await page.locator(".bench-form .problems:not(:empty)").waitFor();
  assert.match(await page.locator(".bench-form .problems").innerText(), /width/);
});

test("an experiment is started, followed and its report sorts by a click", async () => {
  await page.goto(`${server.base}/lab#experiments`);
  const scenes = page.getByLabel("Scenes", { exact: true });
  await scenes.fill("sweep:1x100x3");
  const example = page.locator(`#${await scenes.getAttribute("aria-describedby")}`);
  assert.match(await example.innerText(), /^Such as \S/);
  await page.getByLabel("Techniques", { exact: true }).fill("--out=elsewhere");
  await page.getByRole("button", { name: "Start" }).click();
  await page.locator(".upload .problems", { hasText: "techniques" }).waitFor();
  await page.getByLabel("Techniques", { exact: true }).fill("shadow-map");
  await page.getByRole("button", { name: "Start" }).click();
  const report = page.getByRole("link", { name: "Report" });
  await report.waitFor({ timeout: 120_000 });
  assert.deepEqual(await violations(page), []);
  await page.goto(new URL(await report.getAttribute("href"), server.base).href);
  const runs = page.locator("table").last();
  const times = () => runs.locator("tbody tr").evaluateAll((rows) => rows.map((row) => Number(row.cells[4].dataset.number)));
  await runs.getByRole("button", { name: "frame ms" }).click();
  const sorted = await times();
  assert.equal(sorted.length, 4);  // none and shadow-map at two sizes
  assert.deepEqual(sorted, [...sorted].sort((a, b) => a - b));
  await runs.getByRole("button", { name: "frame ms" }).click();
  assert.deepEqual(await times(), [...sorted].reverse());
});
