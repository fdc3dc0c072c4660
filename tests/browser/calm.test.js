import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { launch, Person } from "./person.js";
import { Server } from "./server.js";
import { small_study } from "./study.js";

const study = "calm";
const source = await readFile(new URL("../../web/participant/strings.js", import.meta.url), "utf8");
const { languages } = await import(`data:text/javascript,${encodeURIComponent(source)}`);
let server;
let browser;

before(async () => {
  server = await Server.start();
  await server.publish(small_study(study, {
    labels: { most: { en: "most pleasant", nl: "prettigst" }, least: { en: "least pleasant", nl: "onprettigst" } },
    thanks: { en: "Thank you: all answers are stored.", nl: "Dank u wel: alle antwoorden zijn bewaard." },
  }));
  browser = await launch();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

test("the interface has the same texts in every language, and none of realism or shadows", () => {
  assert.deepEqual(Object.keys(languages.nl), Object.keys(languages.en));
  assert.deepEqual(Object.keys(languages.nl.errors), Object.keys(languages.en.errors));
  assert.doesNotMatch(source, /realis|shadow|schaduw/i);
});

for (const width of [360, 768, 1440]) {
  test(`at ${width} pixels the bar keeps its height, and says "Saved" only after an answer`, async () => {
    const person = await Person.arrive(browser, server, study, { viewport: { width, height: 900 } });
    await person.enter();
    await person.page.waitForLoadState("networkidle");
    const bar = person.page.locator("#bar");
    const height = (await bar.boundingBox()).height;
    assert.doesNotMatch(await bar.innerText(), /Saved/);
    await person.context.setOffline(true);
    await person.answer({ A: 2, B: 1, C: 0 });
    await person.see_page(1);
    await person.page.getByText("Kept on this device").waitFor();
    assert.equal((await bar.boundingBox()).height, height);
    assert.ok(await person.page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await person.context.setOffline(false);
    await person.page.getByText("Saved", { exact: true }).waitFor();
    assert.equal((await bar.boundingBox()).height, height);
    await person.page.reload();
    await person.see_page(1);
    await person.page.getByText("Saved", { exact: true }).waitFor();
    await person.context.close();
  });
}

test("between two pages the grey stays, and the pictures loaded are counted", async () => {
  const person = await Person.arrive(browser, server, study, { colorScheme: "light" });
  const held = [];
  await person.page.route(/\/pages\/1\/pictures\/[12]$/, (route) => held.push(route));
  await person.enter();
  const ground = () => person.page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const grey = await ground();
  assert.match(grey, /^rgb\((\d+), \1, \1\)$/);
  await person.page.evaluate(() => {
    window.grounds = new Set();
    const look = () => {
      window.grounds.add(getComputedStyle(document.body).backgroundColor);
      requestAnimationFrame(look);
    };
    look();
  });
  await person.answer({ A: 0, B: 1, C: 2 });
  await person.page.getByText("1 of 3", { exact: true }).waitFor();
  assert.equal(await person.page.getByRole("progressbar", { name: "Loading the pictures…" }).evaluate((bar) => bar.value), 1);
  assert.equal(await person.page.locator(".pick").count(), 0);
  await held[0].continue();
  await person.page.getByText("2 of 3", { exact: true }).waitFor();
  await held[1].continue();
  await person.see_page(1);
  assert.deepEqual(await person.page.evaluate(() => [...window.grounds]), [grey]);
  await person.context.close();
});

test("on a phone the confirmation shows question, both ends in the study's words and the way on at once", async () => {
  const height = 640;
  const person = await Person.arrive(browser, server, study, { viewport: { width: 360, height } });
  await person.enter();
  for (const [letter, key] of [["A", "Home"], ["B", "Home"], ["C", "End"]]) await person.picture(letter).press(key);
  await person.rate("easy");
  await person.press("Continue");
  const dialog = person.page.getByRole("dialog");
  await dialog.waitFor();
  assert.equal(await person.page.evaluate(() => document.activeElement.textContent), "Is this right?");
  assert.deepEqual(await dialog.locator(".verdict h3").allInnerTexts(), ["Most pleasant", "Least pleasant"]);
  const [most, least] = await dialog.locator(".verdict").evaluateAll((all) => all.map((each) => each.getBoundingClientRect().toJSON()));
  assert.equal(most.top, least.top);
  assert.ok(most.right <= least.left);
  for (const element of [dialog.getByRole("heading", { name: "Is this right?" }), ...await dialog.getByRole("img").all(),
    ...await dialog.getByRole("button").all()]) {
    const box = await element.boundingBox();
    assert.ok(box.y >= 0 && box.y + box.height <= height && box.x >= 0 && box.x + box.width <= 360, JSON.stringify(box));
  }
  await person.press("Yes, continue");
  await person.see_page(1);
  await person.answer({ A: 0, B: 1, C: 2 });
  await person.completion_code();
  assert.equal((await person.page.locator("main").innerText()).match(/thank you/gi).length, 1);
  await person.context.close();
});

test("in Dutch no word of English is shown from beginning to end, not even when the server refuses", async () => {
  const english = Object.entries(languages.en).filter(([key, text]) => typeof text === "string" && text.length > 8
    && text !== languages.nl[key]).map(([, text]) => text);
  const person = await Person.arrive(browser, server, study, { locale: "nl-NL" });
  const check = async (step) => {
    const shown = await person.page.evaluate(() => document.documentElement.innerText
      + [...document.querySelectorAll("[aria-label], [title], [alt]")].flatMap((each) =>
        ["aria-label", "title", "alt"].map((name) => each.getAttribute(name) ?? "")).join("\n"));
    assert.deepEqual(english.filter((text) => shown.includes(text)), [], step);
    assert.doesNotMatch(shown, /\b(the|picture|server failed|closed|not a UUID)\b/i, step);
  };
  await person.button("Ik ga akkoord en doe mee").waitFor();
  await check("consent");
  await person.page.route(/\/participants$/, (route) => route.fulfill({ status: 409, contentType: "application/json",
    body: JSON.stringify({ error: { code: "conflict", message: "the study is closed", field: "study" } }) }));
  await person.press("Ik ga akkoord en doe mee");
  await person.page.getByText("Dit onderzoek is op dit moment niet open.").waitFor();
  await check("refused entry");
  await person.page.unroute(/\/participants$/);
  await person.press("Ik ga akkoord en doe mee");
  await person.button("Toon de eerste pagina").waitFor();
  await check("how it works");
  await person.press("Toon de eerste pagina");
  await person.see_page(0);
  await check("a page");
  await person.press("Verder");
  await person.page.getByText("Er ontbreekt iets").waitFor();
  await check("something missing");
  await person.page.getByLabel("Ze zien er voor mij allemaal hetzelfde uit").check();
  await person.rate("easy (nl)");
  await person.page.route(/\/pages\/0$/, (route) => route.fulfill({ status: 400, contentType: "application/json",
    body: JSON.stringify({ error: { code: "bad_value", message: "the server failed to read it", field: "difficulty" } }) }));
  await person.press("Verder");
  await person.press("Ja, verder");
  await person.page.getByText("Een antwoord kon niet worden opgeslagen.").waitFor();
  await check("refused answer");
  await person.context.close();
});
