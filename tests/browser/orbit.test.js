// Pages whose pictures can be turned: all together, by mouse, touch and keys, small and enlarged.

import assert from "node:assert/strict";
import path from "node:path";
import { after, before, test } from "node:test";
import { violations } from "./axe.js";
import { launch, Person } from "./person.js";
import { Server } from "./server.js";
import { small_study } from "./study.js";

const orbit = { centre: [0, 0.5, 0], distance: 8, elevation: 25, from: -60, to: 60, frames: 5 };
let server;
let browser;

before(async () => {
  server = await Server.start();
  await server.publish(small_study("turning", { pages: [{ scene: "boxes" },
    { scene: "boxes", id: "boxes-turned", reference: "shown", techniques: ["none", "shadow-map"], orbit }] }));
  await server.publish(small_study("typed", { widget: "numeric", pages: [{ scene: "boxes", orbit }] }));
  browser = await launch();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

const screenshot = async (where, name) => process.env.SCREENSHOTS
  && where.screenshot({ path: path.join(process.env.SCREENSHOTS, `${name}.png`) });

/// The views of all pictures in sight, one number where they are the same.
const views = (page) => page.evaluate(() => [...new Set([...document.querySelectorAll("img[data-turns]")]
  .filter((image) => image.checkVisibility()).map((image) => Number(new URL(image.src).pathname.split("/").at(-1))))]);

const turning = (page) => page.getByRole("slider", { name: "Turn the view" });

/// Goes to the page that can be turned, wherever the order put it.
async function see_turning_page(person) {
  await person.enter();
  if (await turning(person.page).count() > 0) return 0;
  await person.answer({ A: 0, B: 1, C: 2 });
  await turning(person.page).waitFor();
  return 1;
}

test("one slider turns every picture and the reference, and what was turned is exported", async () => {
  const person = await Person.arrive(browser, server, "turning");
  const at = await see_turning_page(person);
  const { page } = person;
  const slider = turning(page);
  assert.deepEqual(await views(page), [2], "the middle one first");
  assert.equal(await slider.getAttribute("aria-valuetext"), "middle");
  await screenshot(page, "orbit-middle");
  // Every view is there before the page is: nothing is fetched while it turns.
  const before = person.requests.length;
  const shots = new Set([await page.locator(".true-picture img").screenshot().then(String)]);
  for (const [key, view, named] of [["ArrowRight", 3, "first view to the right"], ["End", 4, "second view to the right"],
    ["Home", 0, "second view to the left"]]) {
    await slider.press(key);
    assert.deepEqual(await views(page), [view]);
    assert.equal(await slider.getAttribute("aria-valuetext"), named);
    shots.add(await page.locator(".true-picture img").screenshot().then(String));
  }
  assert.equal(shots.size, 4, "each view is another picture");
  // The mouse on the slider, and keys wherever the focus is.
  const box = await slider.boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  assert.deepEqual(await views(page), [2]);
  await person.picture("A").focus();
  await page.keyboard.press(",");
  assert.deepEqual(await views(page), [1]);
  assert.deepEqual(await violations(page), []);
  // Enlarged it turns as well, and back on the page it is as it was left.
  await page.keyboard.press("e");
  const in_viewer = page.locator(".viewer").getByRole("slider", { name: "Turn the view" });
  assert.equal(await in_viewer.inputValue(), "1");
  await page.keyboard.press(".");
  assert.equal(await in_viewer.inputValue(), "2");
  await in_viewer.press("End");
  assert.deepEqual(await views(page), [4]);
  await page.keyboard.press("PageDown");
  assert.deepEqual(await views(page), [4]);
  await screenshot(page, "orbit-viewer");
  assert.deepEqual(await violations(page), []);
  await page.keyboard.press("Escape");
  assert.equal(await slider.inputValue(), "4");
  assert.deepEqual(person.requests.slice(before).filter((request) => /pictures/.test(request.url())), []);
  await page.reload();
  await slider.waitFor();
  assert.deepEqual(await views(page), [2]);
  await person.answer({ A: 0, B: 1 });
  if (at === 0) {
    await person.see_page(1);
    await person.answer({ A: 0, B: 1, C: 2 });
  }
  await person.completion_code();
  const rows = await server.responses("turning");
  const said = Object.fromEntries(rows.map((row) => [row.scene, [row.turns, row.frames_seen]]));
  assert.deepEqual(said, { "boxes": ["0", "0"], "boxes-turned": ["7", "5"] });
  assert.deepEqual(person.faults, []);
  await person.context.close();
});

test("digits are typed beside pictures that turn", async () => {
  const person = await Person.arrive(browser, server, "typed", { colorScheme: "dark", viewport: { width: 768, height: 1024 } });
  await person.enter();
  await turning(person.page).press("ArrowLeft");
  assert.deepEqual(await views(person.page), [1]);
  await screenshot(person.page, "orbit-digits");
  assert.deepEqual(await violations(person.page), []);
  await person.context.close();
});

test("a phone has the slider in view, and a finger turns", async () => {
  const person = await Person.arrive(browser, server, "turning",
    { viewport: { width: 360, height: 740 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true });
  await see_turning_page(person);
  const box = await turning(person.page).boundingBox();
  assert.ok(box.x >= 0 && box.x + box.width <= 360 && box.y + box.height < 740, JSON.stringify(box));
  await person.page.touchscreen.tap(box.x + box.width - 6, box.y + box.height / 2);
  assert.deepEqual(await views(person.page), [4]);
  await screenshot(person.page, "orbit-phone");
  assert.ok(await person.page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  assert.deepEqual(await violations(person.page), []);
  await person.context.close();
});
