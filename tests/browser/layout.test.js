// Everything that a page of nine pictures asks for is in view at once, and few keys do it all.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { violations } from "./axe.js";
import { launch, Person } from "./person.js";
import { Server } from "./server.js";
import { small_study } from "./study.js";

const nine = ["none", "shadow-map", "pcf-3x3", "pcf-bilinear", "vsm-2007", "esm", "projected", "shadow-volumes", "reference"];
const letters = [..."ABCDEFGHI"];
let server;
let browser;

before(async () => {
  server = await Server.start();
  await server.publish(small_study("nine", { techniques: nine, pages: [{ scene: "half-plane" }] }));
  await server.publish(small_study("shown", { techniques: nine.slice(0, 8), pages: [{ scene: "half-plane", reference: "shown" }] }));
  await server.publish(small_study("long", { techniques: nine, pages: [{ scene: "half-plane" }], labels: {
    most: { en: "most", nl: "meest werkelijkheidsgetrouwe schaduwweergave" },
    least: { en: "least", nl: "minst werkelijkheidsgetrouwe schaduwweergave" } } }));
  browser = await launch();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

/// Names of what the window does not show whole. `selectors` name what has to be there.
const hidden = (person, selectors) => person.page.evaluate((wanted) => wanted.flatMap((selector) => {
  const all = [...document.querySelectorAll(selector)];
  if (all.length === 0) return [`no ${selector}`];
  return all.filter((element) => {
    const { left, top, right, bottom, width, height } = element.getBoundingClientRect();
    return width <= 0 || height <= 0 || left < -0.5 || top < -0.5 || right > innerWidth + 0.5 || bottom > innerHeight + 0.5;
  }).map((element) => `${selector} ${element.textContent}`);
}), selectors);

const whole = [".question h1", ".tray", ".shelf", ".picture img", ".letter", ".enlarge", ".difficulty", ".step", ".next", "#all-same"];

/// Puts every picture on a shelf of its own by keys: {letter: shelf}.
async function place_all(person, count) {
  for (const [shelf, letter] of letters.slice(0, count).entries()) {
    await person.picture(letter).focus();
    await person.page.keyboard.press("Home");
    for (let step = 0; step < shelf; ++step) await person.page.keyboard.press("ArrowDown");
  }
}

for (const [width, height] of [[768, 1024], [1280, 720], [1440, 900], [1920, 1080]]) {
  for (const study of ["nine", "shown"]) {
    test(`with every picture placed, study ${study} fits a window of ${width} by ${height}`, async () => {
      const person = await Person.arrive(browser, server, study, { viewport: { width, height }, reducedMotion: "reduce" });
      await person.enter();
      const count = study === "nine" ? 9 : 8;
      const parts = [...whole, ...(study === "shown" ? [".true-picture img"] : [])];
      assert.deepEqual(await hidden(person, parts), []);
      await place_all(person, count);
      assert.deepEqual(Object.values(await person.arrangement()), letters.slice(0, count).map((_, index) => index));
      assert.deepEqual(await hidden(person, parts), []);
      const overflow = await person.page.evaluate(() => [...document.querySelectorAll("html, body, main, .rack, .tray, .finish")]
        .filter((part) => part.scrollHeight > part.clientHeight + 1 || part.scrollWidth > part.clientWidth + 1).map((part) => part.className || part.tagName));
      assert.deepEqual(overflow, []);
      // No picture covers another, its letter or the labels.
      const boxes = await person.page.locator(".picture, .label:not(:empty), .step, .true-picture").evaluateAll((all) => all.map((element) => {
        const { left, top, right, bottom } = element.getBoundingClientRect();
        return { left, top, right, bottom };
      }).filter(({ left, right }) => right > left));
      for (const [index, a] of boxes.entries()) {
        for (const b of boxes.slice(index + 1)) {
          assert.ok(a.right <= b.left + 0.5 || b.right <= a.left + 0.5 || a.bottom <= b.top + 0.5 || b.bottom <= a.top + 0.5, JSON.stringify([a, b]));
        }
      }
      // On a shelf a picture takes at least 80% of the height that a ninth of the window leaves.
      const tall = await person.picture("A").locator("img").evaluate((image) => image.getBoundingClientRect().height);
      assert.ok(tall >= 0.8 * ((height - 52 - 24) / count) - 8, `${tall} of ${height}`);
      // Nine on one shelf still fit; in a narrower window that shelf scrolls.
      if (width >= 1280) for (const letter of letters.slice(1, count)) await person.click_onto(letter, 0);
      assert.deepEqual(await hidden(person, parts), []);
      await person.context.close();
    });
  }
}

for (const [width, height] of [[360, 740], [768, 1024], [1280, 720], [1440, 900]]) {
  test(`long words of Dutch labels stay whole and clear of pictures in a window of ${width} by ${height}`, async () => {
    const person = await Person.arrive(browser, server, "long", { viewport: { width, height }, reducedMotion: "reduce", locale: "nl-NL" });
    await person.press("Ik ga akkoord en doe mee");
    await person.press("Toon de eerste pagina");
    await person.see_page(0);
    for (const [slot, key] of ["Home", "Home", "End"].entries()) {
      await person.page.locator(".tray .pick").first().focus();
      await person.page.keyboard.press(key);
      await person.page.waitForFunction((count) => document.querySelectorAll(".shelf .picture").length === count, slot + 1);
    }
    const faults = await person.page.evaluate(() => [...document.querySelectorAll(".shelf.end")].flatMap((shelf) => {
      const label = shelf.querySelector(".label");
      const text = document.createRange();
      text.selectNodeContents(label);
      const inside = text.getBoundingClientRect();
      const around = shelf.getBoundingClientRect();
      const cut = inside.top < around.top - 0.5 || inside.bottom > around.bottom + 0.5 || inside.left < around.left || inside.right > around.right;
      const covered = [...shelf.querySelectorAll(".picture")].filter((picture) => {
        const box = picture.getBoundingClientRect();
        return box.right > inside.left + 0.5 && box.left < inside.right - 0.5 && box.bottom > inside.top + 0.5 && box.top < inside.bottom - 0.5;
      });
      return [...(cut ? [`${label.textContent} is cut`] : []), ...covered.map(() => `a picture lies on ${label.textContent}`)];
    }));
    assert.deepEqual(faults, []);
    assert.match(await person.page.locator(".shelf.end .label").first().textContent(), /werkelijkheidsgetrouwe/);
    await person.context.close();
  });
}

test("no picture in the tray moves when another is taken, and it returns to its own place", async () => {
  const person = await Person.arrive(browser, server, "nine", { viewport: { width: 1280, height: 720 }, reducedMotion: "reduce" });
  await person.enter();
  const places = () => person.page.locator(".tray .picture").evaluateAll((all) => Object.fromEntries(all.map((item) => {
    const { left, top, width, height } = item.querySelector("img").getBoundingClientRect();
    return [item.querySelector("img").alt.at(-1), [left, top, width, height]];
  })));
  const before_any = await places();
  await person.click_onto("E", 3);
  await person.click_onto("A", 0);
  const after_two = await places();
  assert.deepEqual(Object.keys(after_two), ["B", "C", "D", "F", "G", "H", "I"]);
  for (const [letter, box] of Object.entries(after_two)) assert.deepEqual(box, before_any[letter], letter);
  await person.picture("E").focus();
  await person.page.keyboard.press("Delete");
  assert.deepEqual((await places()).E, before_any.E);
  await person.context.close();
});

/// Counts key presses from the page's first view to the answer's leaving.
class Keys {
  constructor(person) {
    Object.assign(this, { person, count: 0 });
  }

  async press(...keys) {
    for (const key of keys) {
      await this.person.page.keyboard.press(key);
      this.count += 1;
    }
  }

  focused() {
    return this.person.page.evaluate(() => document.activeElement.querySelector("img")?.alt ?? document.activeElement.name ?? "");
  }
}

/// The presses that reach each of nine shelves from the tray.
const ways = [["Home"], ["Home", "ArrowDown"], ["m", "ArrowUp", "ArrowUp"], ["m", "ArrowUp"], ["m"], ["m", "ArrowDown"],
  ["m", "ArrowDown", "ArrowDown"], ["End", "ArrowUp"], ["End"]];

for (const [name, order] of Object.entries({
  "each on a shelf of its own": [4, 0, 8, 2, 6, 1, 7, 3, 5],
  "all on the shelf that is hardest to reach": [2, 2, 2, 2, 2, 2, 2, 2, 2],
})) {
  test(`keys alone answer a page of nine pictures, ${name}, in at most 60 presses`, async () => {
    const person = await Person.arrive(browser, server, "nine", { viewport: { width: 1280, height: 720 }, reducedMotion: "reduce" });
    await person.enter();
    const keys = new Keys(person);
    for (const [index, shelf] of order.entries()) {
      await keys.press("n");
      assert.equal(await keys.focused(), `Picture ${letters[index]}`);
      await keys.press(...ways[shelf]);
    }
    assert.deepEqual(Object.values(await person.arrangement()).sort(), [...order].sort());
    for (const [index, shelf] of order.entries()) assert.equal((await person.arrangement())[letters[index]], shelf);
    await keys.press("n");
    assert.equal(await keys.focused(), "difficulty");
    await keys.press("ArrowDown", "ArrowDown", "ArrowDown", "ArrowDown");
    assert.ok(await person.page.getByRole("radio", { name: "very easy", exact: true }).isChecked());
    const tab_to = async (words) => {
      for (let step = 0; step < 5; ++step) {
        await keys.press("Tab");
        if ((await person.page.evaluate(() => document.activeElement.textContent)) === words) return;
      }
      assert.fail(`the tab key does not reach ${words}`);
    };
    await tab_to("Continue");
    await keys.press("Enter");
    await person.page.getByRole("dialog").waitFor();
    if ((await person.page.evaluate(() => document.activeElement.textContent)) !== "Yes, continue") await tab_to("Yes, continue");
    await keys.press("Enter");
    await person.completion_code();
    assert.ok(keys.count <= 60, `${keys.count} presses`);
    console.log(`# ${keys.count} presses, ${name}`);
    await person.context.close();
  });
}

test("the tab key stops once among the pictures and once among the shelves; arrows reach the rest", async () => {
  const person = await Person.arrive(browser, server, "nine", { viewport: { width: 1280, height: 720 } });
  await person.enter();
  await person.click_onto("D", 4);
  const stops = await person.page.evaluate(() => ["pick", "enlarge", "place"].map((name) =>
    [...document.querySelectorAll(`.${name}`)].filter((button) => button.tabIndex === 0).length));
  assert.deepEqual(stops, [1, 1, 1]);
  const keys = new Keys(person);
  await person.picture("A").focus();
  const seen = [await keys.focused()];
  for (let step = 0; step < 8; ++step) {
    await keys.press("ArrowRight");
    seen.push(await keys.focused());
  }
  assert.deepEqual(seen.map((name) => name.at(-1)).sort(), letters);
  await person.picture("A").focus();
  await keys.press("Enter");
  await person.page.locator(".place[tabindex='0']").focus();
  await keys.press("ArrowDown", "ArrowDown", "Enter");
  assert.equal((await person.arrangement()).A, 6);  // two below the shelf last chosen
  await person.context.close();
});

test("a picture rested on is shown in actual size beside it, and goes when the pointer or the focus does", async () => {
  const person = await Person.arrive(browser, server, "nine", { viewport: { width: 1280, height: 720 }, deviceScaleFactor: 0.5, reducedMotion: "reduce" });
  await person.enter();
  const glance = person.page.locator(".glance");
  assert.ok(await glance.isHidden());
  for (const letter of ["A", "I"]) {
    const picture = await person.picture(letter).boundingBox();
    await person.page.mouse.move(picture.x + 5, picture.y + 5);
    await person.page.mouse.move(picture.x + 20, picture.y + 20, { steps: 3 });
    await glance.waitFor();
    // 128 picture pixels at half a device pixel per CSS pixel.
    const box = await glance.locator("img").boundingBox();
    assert.ok(Math.abs(box.width - 256) < 0.01 && Math.abs(box.height - 256) < 0.01, JSON.stringify(box));
    assert.ok(box.x >= picture.x + picture.width || box.x + box.width <= picture.x, "it covers what it shows");
    assert.equal(await glance.locator("p").innerText(), `Picture ${letter}: not placed yet`);
    await person.page.mouse.move(picture.x + 20, 3);
    await glance.waitFor({ state: "hidden" });
  }
  await person.page.keyboard.press("n");
  await glance.waitFor();
  await person.page.keyboard.press("Escape");
  await glance.waitFor({ state: "hidden" });
  await person.page.keyboard.press("Home");
  await glance.waitFor();
  assert.match(await glance.locator("p").innerText(), /: top shelf, most realistic$/);
  await person.picture("C").dblclick();
  await person.page.getByRole("dialog").waitFor();
  assert.ok(await glance.isHidden());
  assert.equal(await person.page.locator(".viewer-stage img").first().getAttribute("alt"), "Picture C");
  assert.deepEqual((await person.arrangement()).C, null);
  await person.context.close();
});

test("two pictures stand side by side in the viewer with their letters and places, and move together", async () => {
  const person = await Person.arrive(browser, server, "nine", { viewport: { width: 1280, height: 720 } });
  await person.enter();
  await person.click_onto("B", 1);
  await person.picture("A").focus();
  await person.page.keyboard.press("e");
  await person.page.keyboard.press("s");
  const panes = person.page.locator(".pane");
  assert.deepEqual(await panes.locator("figcaption").allInnerTexts(), ["Picture A: not placed yet", "Picture B: second shelf from the top"]);
  const boxes = await panes.locator("img").evaluateAll((all) => all.map((image) => image.getBoundingClientRect().toJSON()));
  assert.ok(boxes.every(({ width }) => width === 128) && boxes[0].right < boxes[1].left && boxes[0].top === boxes[1].top);
  for (let step = 0; step < 3; ++step) await person.page.keyboard.press("+");
  await person.page.locator(".viewer-stage").first().evaluate((stage) => stage.scrollTo(210, 170));
  await person.page.waitForFunction(() => {
    const [left, right] = document.querySelectorAll(".viewer-stage");
    return left.scrollTop === 170 && right.scrollTop === 170 && right.scrollLeft === 210;
  });
  await person.page.keyboard.press("-");
  await person.page.waitForFunction(() => {
    const [left, right] = document.querySelectorAll(".viewer-stage");
    return left.scrollTop === right.scrollTop && left.scrollLeft === right.scrollLeft && left.querySelector("img").getBoundingClientRect().width === 512;
  });
  assert.match(await person.page.locator(".viewer .keys").innerText(), /side by side/);
  assert.deepEqual(await violations(person.page), []);
  await person.page.keyboard.press(" ");
  assert.match(await panes.locator("figcaption").first().innerText(), /^Picture B/);
  await person.context.close();
});

for (const [width, height] of [[360, 740], [390, 844]]) {
  test(`on a phone of ${width} by ${height} only the shelves scroll`, async () => {
    const person = await Person.arrive(browser, server, "shown",
      { viewport: { width, height }, deviceScaleFactor: 2, hasTouch: true, isMobile: true, reducedMotion: "reduce" });
    await person.enter();
    await place_all(person, 8);
    const measures = await person.page.evaluate(() => {
      const rack = document.querySelector(".rack");
      rack.scrollTo(0, 0);
      const main = document.querySelector("main");
      return { page: document.documentElement.scrollHeight - innerHeight, main: main.scrollHeight - main.clientHeight,
        rack: rack.scrollHeight - rack.clientHeight, shelves: rack.clientHeight };
    });
    assert.ok(measures.page <= 0 && measures.main <= 1, JSON.stringify(measures));
    assert.ok(measures.rack > 100 && measures.shelves >= 160, JSON.stringify(measures));
    const fixed = [".question h1", ".true-picture img", ".difficulty", ".step", ".next", "#all-same"];
    assert.deepEqual(await hidden(person, fixed), []);
    await person.page.locator(".rack").evaluate((rack) => rack.scrollTo(0, rack.scrollHeight));
    assert.deepEqual(await hidden(person, fixed), []);
    await person.picture("H").scrollIntoViewIfNeeded();
    assert.deepEqual(await violations(person.page), []);
    await person.context.close();
  });
}

test("in a window enlarged to 200% everything is reached by scrolling down", async () => {
  const person = await Person.arrive(browser, server, "nine", { viewport: { width: 640, height: 360 }, deviceScaleFactor: 2, reducedMotion: "reduce" });
  await person.enter();
  assert.ok(await person.page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  await person.answer(Object.fromEntries(letters.map((letter, index) => [letter, index])), "easy");
  await person.completion_code();
  await person.context.close();
});
