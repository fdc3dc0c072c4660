import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, Person } from "./person.js";
import { Server } from "./server.js";
import { small_study, techniques } from "./study.js";

const study = "small";
let server;
let browser;

before(async () => {
  server = await Server.start();
  await server.publish(small_study(study));
  browser = await launch();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

/// Runs one person's visit and returns the rows that the visit added to responses.csv.
async function visit(course, options = {}) {
  const known = new Set((await server.responses(study)).map((row) => row.participant));
  const person = await Person.arrive(browser, server, study, options);
  await course(person);
  assert.deepEqual(person.faults.filter((fault) => !fault.includes("ERR_INTERNET_DISCONNECTED") && !fault.includes("net::ERR_FAILED")), []);
  await person.context.close();
  return (await server.responses(study)).filter((row) => !known.has(row.participant));
}

/// {slot: shelf} of the page at a position.
const shelves_at = (rows, position) => Object.fromEntries(rows.filter((row) => Number(row.page_index) === position)
  .map((row) => [row.slot, Number(row.shelf_0_is_most_realistic)]));

test("a person goes through a study with mouse and keyboard, and the answers are in responses.csv", async () => {
  const rows = await visit(async (person) => {
    await person.enter();
    await person.click_onto("A", 2);
    await person.picture("B").focus();
    await person.page.keyboard.press("Home");
    await person.picture("C").focus();
    await person.page.keyboard.press("End");
    await person.page.keyboard.press("ArrowUp");
    assert.match(await person.page.locator("#live").innerText(), /^Picture C: second shelf/);
    assert.equal(await person.page.evaluate(() => document.activeElement.querySelector("img").alt), "Picture C");
    await person.rate("very easy");
    await person.confirm();
    await person.see_page(1);
    await person.answer({ A: 0, B: 0, C: 2 }, "hard");
    assert.equal(await person.completion_code(), "SHADE");
    assert.match(await person.page.locator(".code").nth(1).innerText(), /\S{6,}/);
  });
  assert.equal(rows.length, 6);
  assert.deepEqual(shelves_at(rows, 0), { 0: 2, 1: 0, 2: 1 });
  assert.deepEqual(shelves_at(rows, 1), { 0: 0, 1: 0, 2: 2 });
  const second = rows.filter((row) => row.page_index === "1");
  assert.deepEqual(second.map((row) => Number(row.rank_1_is_most_realistic)).sort(), [1.5, 1.5, 3]);
  assert.deepEqual(new Set(rows.map((row) => `${row.page_index}:${row.difficulty_1_hard_to_see_5_easy}`)), new Set(["0:5", "1:2"]));
  for (const position of ["0", "1"]) {
    assert.deepEqual(rows.filter((row) => row.page_index === position).map((row) => row.technique).sort(), [...techniques].sort());
  }
  assert.ok(rows.every((row) => Number(row.active_ms) > 0 && Number(row.active_ms) <= Number(row.total_ms)));
});

test("a picture is dragged to a shelf, and from there to another and back to the tray", async () => {
  await visit(async (person) => {
    await person.enter();
    const drag = async (letter, target) => {
      await person.page.waitForFunction(() => document.getAnimations().length === 0);
      const from = await person.picture(letter).boundingBox();
      const to = await target.boundingBox();
      await person.page.mouse.move(from.x + from.width / 2, from.y + from.height / 2);
      await person.page.mouse.down();
      await person.page.mouse.move(from.x + from.width / 2 + 15, from.y + from.height / 2, { steps: 3 });
      await person.page.mouse.move(to.x + to.width * 0.8, to.y + to.height / 2, { steps: 10 });
      await person.page.mouse.up();
    };
    await drag("B", person.shelf(1));
    assert.deepEqual(await person.arrangement(), { A: null, B: 1, C: null });
    await drag("B", person.shelf(2));
    assert.deepEqual(await person.arrangement(), { A: null, B: 2, C: null });
    await drag("B", person.page.locator(".tray"));
    assert.deepEqual(await person.arrangement(), { A: null, B: null, C: null });
  });
});

test("on a phone a held picture is dragged by finger, while a swipe over the shelves scrolls them", async () => {
  await visit(async (person) => {
    await person.enter();
    const devtools = await person.context.newCDPSession(person.page);
    const touch = (type, x, y) => devtools.send("Input.dispatchTouchEvent", { type, touchPoints: type === "touchEnd" ? [] : [{ x, y }] });
    const stroke = async (from, to, hold_ms) => {
      await touch("touchStart", ...from);
      await person.page.waitForTimeout(hold_ms);
      for (let step = 1; step <= 10; ++step) {
        await touch("touchMove", from[0] + ((to[0] - from[0]) * step) / 10, from[1] + ((to[1] - from[1]) * step) / 10);
        await person.page.waitForTimeout(16);
      }
      await touch("touchEnd");
    };
    const picture = await person.picture("B").boundingBox();
    const shelf = await person.shelf(1).boundingBox();
    const middle = [picture.x + picture.width / 2, picture.y + picture.height / 2];
    await stroke(middle, [shelf.x + shelf.width / 2, shelf.y + shelf.height / 2], 500);
    assert.deepEqual(await person.arrangement(), { A: null, B: 1, C: null });
    const scrolled = () => person.page.evaluate(() => [scrollY, document.querySelector(".rack").scrollTop]);
    assert.deepEqual(await scrolled(), [0, 0]);
    const placed = await person.picture("B").boundingBox();
    const on_shelf = [placed.x + placed.width / 2, placed.y + placed.height / 2];
    await stroke(on_shelf, [on_shelf[0], on_shelf[1] - 150], 0);
    await person.page.waitForFunction(() => document.querySelector(".rack").scrollTop > 20);
    assert.equal((await scrolled())[0], 0);
    assert.deepEqual(await person.arrangement(), { A: null, B: 1, C: null });
  }, { viewport: { width: 360, height: 640 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
});

test("a reload in the middle resumes with everything as it was, in a second tab too", async () => {
  const rows = await visit(async (person) => {
    await person.enter();
    await person.answer({ A: 0, B: 1, C: 2 });
    await person.see_page(1);
    await person.click_onto("C", 0);
    await person.rate("neither");
    await person.page.reload();
    await person.see_page(1);
    assert.deepEqual(await person.arrangement(), { A: null, B: null, C: 0 });
    assert.ok(await person.page.getByRole("radio", { name: "neither", exact: true }).isChecked());
    const tab = Object.assign(new Person(), person, { page: await person.context.newPage() });
    await tab.open();
    await tab.see_page(1);
    assert.deepEqual(await tab.arrangement(), { A: null, B: null, C: 0 });
    await tab.click_onto("A", 1);
    await tab.click_onto("B", 2);
    await tab.confirm();
    assert.equal(await tab.completion_code(), "SHADE");
    await person.page.reload();
    assert.equal(await person.completion_code(), "SHADE");
  });
  assert.equal(rows.length, 6);
  assert.deepEqual(shelves_at(rows, 1), { 0: 1, 1: 2, 2: 0 });
});

test("without a network the person goes on, and nothing is lost or doubled when it returns", async () => {
  const rows = await visit(async (person) => {
    await person.enter();
    await person.page.waitForLoadState("networkidle");
    await person.context.setOffline(true);
    await person.answer({ A: 2, B: 1, C: 0 });
    await person.see_page(1);
    await person.page.getByText("Kept on this device").waitFor();
    await person.answer({ A: 1, B: 1, C: 1 });
    await person.page.getByText("Sending your last answers").waitFor();
    assert.equal(await person.page.locator(".code").count(), 0);
    await person.context.setOffline(false);
    assert.equal(await person.completion_code(), "SHADE");
  });
  assert.equal(rows.length, 6);
  assert.deepEqual(shelves_at(rows, 0), { 0: 2, 1: 1, 2: 0 });
  assert.deepEqual(shelves_at(rows, 1), { 0: 1, 1: 1, 2: 1 });
});

test("an answer whose reply is lost is sent again under the same id, even after a reload", async () => {
  const sent = [];
  const rows = await visit(async (person) => {
    await person.enter();
    await person.page.route(/\/pages\/0$/, async (route) => {
      sent.push(route.request().postDataJSON().answer_id);
      await route.fetch();
      await route.abort();
    });
    await person.answer({ A: 0, B: 2, C: 1 });
    await person.see_page(1);
    await person.page.getByText("Kept on this device").waitFor();
    await person.page.unroute(/\/pages\/0$/);
    const again = person.page.waitForRequest((request) => request.method() === "PUT" && request.url().endsWith("/pages/0"));
    await person.page.reload();
    sent.push((await again).postDataJSON().answer_id);
    await person.see_page(1);
    await person.page.getByText("Saved", { exact: true }).waitFor();
  });
  assert.ok(sent.length >= 2);
  assert.equal(new Set(sent).size, 1);
  assert.equal(rows.length, 3);
});

test("a changed answer replaces the earlier one under a new id, an unchanged one is not sent again", async () => {
  const sent = [];
  const rows = await visit(async (person) => {
    person.context.on("request", (request) => {
      if (request.method() === "PUT") sent.push(request.postDataJSON());
    });
    await person.enter();
    await person.answer({ A: 0, B: 1, C: 2 });
    await person.see_page(1);
    await person.press("Back");
    await person.see_page(0);
    assert.deepEqual(await person.arrangement(), { A: 0, B: 1, C: 2 });
    await person.confirm();
    await person.see_page(1);
    assert.equal(sent.length, 1);
    await person.page.goBack();
    await person.see_page(0);
    await person.click_onto("A", 1);
    await person.confirm();
    await person.see_page(1);
    await person.page.getByText("Saved", { exact: true }).waitFor();
  });
  assert.equal(sent.length, 2);
  assert.notEqual(sent[0].answer_id, sent[1].answer_id);
  assert.deepEqual(shelves_at(rows, 0), { 0: 1, 1: 1, 2: 2 });
});

test("a page is left only when everything is answered, and the focus goes to what is missing", async () => {
  await visit(async (person) => {
    await person.enter();
    await person.click_onto("A", 0);
    await person.press("Continue");
    const alert = person.page.locator(".problems");
    assert.match(await alert.innerText(), /Not on a shelf yet: Picture B, Picture C\./);
    assert.match(await alert.innerText(), /Please say how hard it was/);
    assert.equal(await person.page.evaluate(() => document.activeElement.querySelector("img")?.alt), "Picture B");
    await person.click_onto("B", 0);
    await person.click_onto("C", 1);
    await person.press("Continue");
    assert.doesNotMatch(await alert.innerText(), /Not on a shelf/);
    assert.equal(await person.page.evaluate(() => document.activeElement.name), "difficulty");
    assert.equal(await person.page.getByRole("dialog").count(), 0);
    await person.rate("hard");
    await person.press("Continue");
    await person.page.getByRole("dialog").waitFor();
    await person.press("No, go back");
    await person.see_page(0);
  });
});

test("an order read the wrong way round is turned before it is sent, and that is on record", async () => {
  const rows = await visit(async (person) => {
    await person.enter();
    for (const [letter, shelf] of [["A", 0], ["B", 0], ["C", 2]]) await person.click_onto(letter, shelf);
    await person.rate("easy");
    await person.press("Continue");
    const most = () => person.page.locator(".verdict").first().getByRole("img").evaluateAll((all) => all.map((image) => image.alt));
    assert.deepEqual(await most(), ["Picture A", "Picture B"]);
    await person.press("It is the other way round");
    assert.deepEqual(await most(), ["Picture C"]);
    await person.press("Yes, continue");
    await person.see_page(1);
    await person.page.getByText("Saved", { exact: true }).waitFor();
  });
  assert.deepEqual(shelves_at(rows, 0), { 0: 2, 1: 2, 2: 0 });
  assert.ok(rows.every((row) => row.swapped_direction === "TRUE"));
});

test("'all look the same' is an answer of its own", async () => {
  const rows = await visit(async (person) => {
    await person.enter();
    await person.page.getByLabel("They all look the same to me").check();
    await person.rate("very hard");
    await person.press("Continue");
    await person.page.getByText("all pictures look the same").waitFor();
    await person.press("Yes, continue");
    await person.see_page(1);
    await person.page.getByText("Saved", { exact: true }).waitFor();
  });
  assert.deepEqual(rows.map((row) => Number(row.rank_1_is_most_realistic)), [2, 2, 2]);
});

test("enlarged, a picture has one device pixel per picture pixel, and two flip in the same place", async () => {
  const rows = await visit(async (person) => {
    await person.enter();
    await person.picture("A").focus();
    await person.page.keyboard.press("e");
    const image = person.page.locator(".viewer-stage img");
    const before = await image.boundingBox();
    assert.ok(Math.abs(before.width * 2 - 128) < 0.01);
    await person.page.getByRole("button", { name: "Picture B", exact: true }).click();
    await person.press("Flip to Picture A");
    assert.equal(await image.getAttribute("alt"), "Picture A");
    assert.deepEqual(await image.boundingBox(), before);
    await person.press("Close");
    await person.answer({ A: 0, B: 1, C: 2 });
    await person.see_page(1);
    await person.page.getByText("Saved", { exact: true }).waitFor();
  }, { deviceScaleFactor: 2 });
  assert.ok(rows.every((row) => row.enlarged === "2" && row.flipped === "1"));
});

test("a picture that cannot be loaded is asked for again, and the failure is on record", async () => {
  let sent = null;
  await visit(async (person) => {
    await person.page.route(/\/pages\/0\/pictures\/1$/, (route) => route.abort());
    await person.press("I agree and want to take part");
    await person.press("Show the first page");
    await person.page.getByText("Not every picture could be loaded").waitFor();
    assert.equal(await person.page.locator(".pick").count(), 0);
    await person.page.unroute(/\/pages\/0\/pictures\/1$/);
    await person.press("Try again");
    await person.see_page(0);
    person.page.on("request", (request) => request.method() === "PUT" && (sent = request.postDataJSON()));
    await person.answer({ A: 0, B: 1, C: 2 });
    await person.see_page(1);
  });
  assert.equal(sent.load_failures, 1);
});

test("pictures that a busy server refuses come a little later, without a word", async () => {
  let refused = 0;
  let sent = null;
  await visit(async (person) => {
    await person.page.route(/\/pages\/0\/pictures\/1$/, (route) => {
      if (refused === 3) return route.continue();
      return route.fulfill({ status: refused++ === 0 ? 429 : 503 });
    });
    await person.press("I agree and want to take part");
    await person.press("Show the first page");
    await person.see_page(0);
    person.page.on("request", (request) => request.method() === "PUT" && (sent = request.postDataJSON()));
    await person.answer({ A: 0, B: 1, C: 2 });
    await person.see_page(1);
    // The browser itself notes each of them on its console.
    assert.equal(person.faults.length, 3);
    assert.ok(person.faults.splice(0).every((fault) => /status of (429|503)/.test(fault)));
  });
  assert.equal(refused, 3);
  assert.ok(!sent.load_failures);
});

test("with the withdrawal code a person deletes every answer", async () => {
  const rows = await visit(async (person) => {
    await person.enter();
    await person.answer({ A: 0, B: 1, C: 2 });
    await person.see_page(1);
    await person.answer({ A: 0, B: 1, C: 2 });
    const code = await person.page.locator(".code").nth(1).innerText();
    await person.page.getByText("Delete answers").click();
    await person.page.getByLabel("Withdrawal code").fill(` ${code.replaceAll("-", "").toLowerCase()} `);
    await person.press("Delete all answers");
    await person.page.getByText("All answers given under this code are deleted.").waitFor();
  });
  assert.equal(rows.length, 0);
});
