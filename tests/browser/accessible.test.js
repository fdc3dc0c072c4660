import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { violations } from "./axe.js";
import { launch, Person } from "./person.js";
import { Server } from "./server.js";
import { small_study } from "./study.js";

const study = "open-to-all";
let server;
let browser;

before(async () => {
  server = await Server.start();
  await server.publish(small_study(study, { demographics: [{ id: "experience", required: true,
    question: { en: "Do you make pictures?", nl: "Maakt u plaatjes?" },
    options: [{ id: "yes", text: { en: "Yes", nl: "Ja" } }, { id: "no", text: { en: "No", nl: "Nee" } }] }] }));
  browser = await launch();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

const screens = {
  "a desktop in light mode": { viewport: { width: 1440, height: 900 }, colorScheme: "light" },
  "a desktop in dark mode": { viewport: { width: 1440, height: 900 }, colorScheme: "dark" },
  "a tablet 768 pixels wide": { viewport: { width: 768, height: 1024 }, colorScheme: "dark", hasTouch: true },
  "a phone 360 pixels wide": { viewport: { width: 360, height: 740 }, deviceScaleFactor: 2, hasTouch: true },
};

for (const [name, options] of Object.entries(screens)) {
  describe(`on ${name}`, () => {
    test("axe finds nothing to object to on any step, and nothing sticks out sideways", async () => {
      const person = await Person.arrive(browser, server, study, { ...options, reducedMotion: "reduce" });
      const check = async (step) => {
        assert.deepEqual(await violations(person.page), [], step);
        const [inner, outer] = await person.page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
        assert.ok(inner <= outer, `${step}: ${inner} in ${outer}`);
      };
      await person.button("I agree and want to take part").waitFor();
      await check("consent");
      await person.press("I agree and want to take part");
      await person.button("Show the first page").waitFor();
      await check("how it works");
      await person.press("Show the first page");
      await person.see_page(0);
      await check("nothing placed");
      await person.picture("A").click();
      await check("a picture chosen");
      await person.shelf(0).locator(".place").click();
      await person.press("Continue");
      await check("something missing");
      await person.press("Enlarge Picture B");
      await person.page.getByRole("dialog").waitFor();
      await check("enlarged");
      await person.page.keyboard.press("Escape");
      await person.click_onto("B", 1);
      await person.click_onto("C", 2);
      await person.rate("easy");
      await check("all placed");
      await person.press("Continue");
      await person.page.getByRole("dialog").waitFor();
      await check("is this right");
      await person.press("Yes, continue");
      await person.see_page(1);
      await person.page.getByLabel("They all look the same to me").check();
      await check("all the same");
      await person.rate("very hard");
      await person.confirm();
      await person.page.getByText("About you").waitFor();
      await check("about you");
      await person.press("Continue");
      await person.page.getByText("Something is missing").waitFor();
      await person.page.getByRole("radio", { name: "No" }).check();
      await person.press("Continue");
      await person.completion_code();
      await check("the end");
      await person.context.close();
    });
  });
}

test("the focus can be seen wherever the tab key takes it", async () => {
  const person = await Person.arrive(browser, server, study);
  await person.enter();
  const seen = new Set();
  for (let step = 0; step < 20; ++step) {
    await person.page.keyboard.press("Tab");
    const focus = await person.page.evaluate(() => {
      const style = getComputedStyle(document.activeElement);
      return { what: document.activeElement.className || document.activeElement.name || document.activeElement.tagName,
        width: parseFloat(style.outlineWidth), style: style.outlineStyle };
    });
    if (focus.what === "BODY" || focus.what === "judging") break;
    seen.add(focus.what);
    assert.ok(focus.width >= 2 && focus.style !== "none", JSON.stringify(focus));
  }
  for (const what of ["pick", "enlarge", "place", "difficulty"]) assert.ok(seen.has(what), `${what} in ${[...seen]}`);
  await person.context.close();
});

test("a Dutch browser gets the study in Dutch", async () => {
  const person = await Person.arrive(browser, server, study, { locale: "nl-NL" });
  await person.page.getByRole("heading", { name: "Schaduwen" }).waitFor();
  assert.equal(await person.page.evaluate(() => document.documentElement.lang), "nl");
  await person.press("Ik ga akkoord en doe mee");
  await person.press("Toon de eerste pagina");
  await person.page.getByRole("button", { name: /^Plaatje A ?, nog niet geplaatst/ }).waitFor();
  await person.context.close();
});
