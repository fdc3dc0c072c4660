// The researcher's pages with a study that people took part in, in windows of every width.

import assert from "node:assert/strict";
import path from "node:path";
import { after, before, test } from "node:test";
import { violations } from "./axe.js";
import { launch } from "./person.js";
import { Server } from "./server.js";
import { small_study } from "./study.js";

const study = small_study("filled", {
  title: { en: "Which shadows of this small scene look real to people?", nl: "Schaduwen" },
  techniques: ["none", "projected", "shadow-map", "pcf-3x3", "reference"],
  pages: [{ scene: "half-plane" }, { scene: "boxes" }, { scene: "car" }],
  arms: [{ id: "one-is-best", widget: "numeric" }, { id: "nine-is-best", widget: "numeric", best_digit: 9 }, { id: "shelves", widget: "shelves" }],
  widget: undefined,
});
let server;
let browser;

before(async () => {
  server = await Server.start();
  await server.simulate(study, "--participants", "24", "--inverted", "3", "--random", "1", "--step", "1.5", "--seed", "8");
  await server.call("POST", "/api/v1/studies", { ...study, quota: 100 });  // a draft beside it
  browser = await launch();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

/// What every page is waited for, and what is opened on it.
const pages = {
  studies: { at: "#studies", there: (page) => page.getByRole("heading", { name: "New study" }) },
  study: { at: "#study/filled", there: (page) => page.getByRole("heading", { name: "Ways of giving ranks" }), open: ["Figures for print (SVG)", "Answers by picture and position", "half-plane", "QR code"] },
  people: { at: "#people/filled/1", there: (page) => page.locator(".people tbody tr").nth(20), open: ["Timeline"] },
  edit: { at: "#edit/filled/2", there: (page) => page.getByLabel("Study file (JSON)") },
  bench: { at: "#bench", there: (page) => page.getByRole("button", { name: "Render" }) },
  compare: { at: "#compare", there: (page) => page.locator(".bench-form") },
  experiments: { at: "#experiments", there: (page) => page.getByRole("button", { name: "Start" }) },
};

// 720 CSS pixels of a screen with 1440: what enlarging to 200% leaves.
for (const [name, options] of Object.entries({
  "1440 pixels, light": { viewport: { width: 1440, height: 900 } },
  "1440 pixels, dark": { viewport: { width: 1440, height: 900 }, colorScheme: "dark" },
  "768 pixels, light": { viewport: { width: 768, height: 1024 } },
  "360 pixels, dark": { viewport: { width: 360, height: 740 }, colorScheme: "dark" },
  "1440 pixels enlarged to 200%": { viewport: { width: 720, height: 450 }, deviceScaleFactor: 2 },
})) {
  test(`every page of the laboratory reads well at ${name}`, async () => {
    const context = await browser.newContext({ reducedMotion: "reduce", ...options });
    const page = await context.newPage();
    const faults = [];
    page.on("pageerror", (error) => faults.push(error.message));
    page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
    await page.goto(`${server.base}/lab?token=${server.token}`);
    for (const [what, { at, there, open }] of Object.entries(pages)) {
      await page.goto(`${server.base}/lab${at}`);
      await there(page).waitFor();
      for (const summary of open ?? []) await page.locator("summary", { hasText: summary }).first().click();
      if (what === "study") await page.locator(".figure-list li a").nth(3).waitFor();
      if (process.env.SCREENSHOTS)
        await page.screenshot({ path: path.join(process.env.SCREENSHOTS, `lab-${what}-${name.replace(/\W+/g, "-")}.png`), fullPage: true });
      assert.deepEqual(await violations(page), [], what);
      const wide = await page.evaluate(() => {
        const scrolls = (element) => element.closest(".scroll, textarea, pre") !== null;
        return document.documentElement.scrollWidth <= innerWidth ? []
          : [...document.querySelectorAll("main *")].filter((element) => element.getBoundingClientRect().right > innerWidth + 1 && !scrolls(element))
            .map((element) => `${element.tagName}.${element.className}`);
      });
      assert.deepEqual(wide, [], `${what} sticks out sideways`);
    }
    assert.deepEqual(faults, []);
    await context.close();
  });
}

test("the report of a study has nothing that axe objects to, and fits a phone", async () => {
  const page = await (await browser.newContext({ viewport: { width: 360, height: 740 } })).newPage();
  await page.goto(`${server.base}/lab?token=${server.token}`);
  await page.goto(`${server.base}/api/v1/studies/filled/report.html`);
  await page.getByRole("heading", { name: "Ways of giving ranks" }).waitFor();
  assert.deepEqual(await violations(page), []);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  if (process.env.SCREENSHOTS) await page.screenshot({ path: path.join(process.env.SCREENSHOTS, "report-360.png"), fullPage: true });
});
