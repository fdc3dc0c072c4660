import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { violations } from "./axe.js";
import { launch, Person } from "./person.js";
import { Server } from "./server.js";
import { small_study } from "./study.js";

let server;
let browser;

before(async () => {
  server = await Server.start();
  browser = await launch();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

const one_page = { pages: [{ scene: "half-plane" }] };

test("where a study repeats digits, they are stored as they were given", async () => {
  await server.publish(small_study("digits", { ...one_page, widget: "numeric" }));
  const person = await Person.arrive(browser, server, "digits");
  await person.press("I agree and want to take part");
  await person.page.getByText("Give every picture a digit, from 1 for “most realistic” to 9 for “least realistic”.").waitFor();
  assert.doesNotMatch(await person.page.locator("main").innerText(), /shelf|shelves|drag/i);
  await person.press("Show the first page");
  await person.see_page(0);
  await person.page.getByText("1 is “most realistic”, 9 is “least realistic”.").waitFor();
  const rank = (letter, digit) => person.page.getByLabel(`Digit for Picture ${letter}`).selectOption(digit);
  await rank("A", "7");
  await person.press("Continue");
  await person.page.getByText("Please give a digit to Picture B, Picture C.").waitFor();
  await rank("B", "2");
  await rank("C", "2");
  await person.rate("neither");
  assert.deepEqual(await violations(person.page), []);
  await person.confirm();
  await person.completion_code();
  const rows = await server.responses("digits");
  assert.deepEqual(Object.fromEntries(rows.map((row) => [row.slot, row.digit_as_typed])), { 0: "7", 1: "2", 2: "2" });
  assert.deepEqual(Object.fromEntries(rows.map((row) => [row.slot, Number(row.rank_1_is_most_realistic)])), { 0: 3, 1: 1.5, 2: 1.5 });
  await person.context.close();
});

test("the true picture stands beside the others where the study shows it, and can be flipped to", async () => {
  await server.publish(small_study("shown", { pages: [{ scene: "half-plane", techniques: ["none", "shadow-map"], reference: "shown" }] }));
  const person = await Person.arrive(browser, server, "shown");
  await person.enter();
  assert.equal(await person.page.locator(".shelved .picture").count(), 2);
  await person.press("Enlarge The true picture, for comparison");
  await person.page.getByRole("button", { name: "Picture A", exact: true }).click();
  await person.press("Flip to The true picture, for comparison");
  assert.deepEqual(await violations(person.page), []);
  await person.context.close();
});

test("a practice page comes first, says so, and is not in the answers", async () => {
  await server.publish(small_study("practised", { ...one_page, practice: { scene: "boxes", techniques: ["reference", "none"] } }));
  const person = await Person.arrive(browser, server, "practised");
  await person.enter();
  await person.page.getByText("It does not count.").waitFor();
  await person.click_onto("A", 0);
  await person.click_onto("B", 1);
  await person.confirm();
  await person.page.getByText("This page does not count.").waitFor();
  await person.press("Continue");
  await person.see_page(1);
  assert.equal(await person.page.getByText("It does not count.").count(), 0);
  await person.answer({ A: 0, B: 1, C: 2 });
  await person.completion_code();
  assert.deepEqual((await server.responses("practised")).map((row) => row.scene), ["half-plane", "half-plane", "half-plane"]);
  await person.context.close();
});

test("a study with enough participants thanks whoever comes later", async () => {
  await server.publish(small_study("small-quota", { ...one_page, quota: 1 }));
  const first = await Person.arrive(browser, server, "small-quota");
  await first.enter();
  await first.answer({ A: 0, B: 1, C: 2 });
  await first.completion_code();
  const second = await Person.arrive(browser, server, "small-quota");
  await second.page.getByText("This survey takes no more participants.").waitFor();
  await first.context.close();
  await second.context.close();
});

test("what a study demands of window and device is said, and lifted when it is met", async () => {
  await server.publish(small_study("large", { ...one_page, minimum_window: { width: 1000, height: 600 }, phones_allowed: false }));
  const person = await Person.arrive(browser, server, "large", { viewport: { width: 800, height: 900 } });
  await person.page.getByText("Please make this window larger").waitFor();
  assert.ok(await person.button("I agree and want to take part").isHidden());
  await person.page.setViewportSize({ width: 1100, height: 700 });
  await person.button("I agree and want to take part").waitFor();
  const phone = await Person.arrive(browser, server, "large",
    { viewport: { width: 390, height: 800 }, screen: { width: 390, height: 844 }, isMobile: true, hasTouch: true });
  await phone.page.getByText("Please open this survey on a tablet or computer").waitFor();
  await person.context.close();
  await phone.context.close();
});

test("parameters of the link that the study names travel with the participant, others do not", async () => {
  await server.publish(small_study("linked", { ...one_page, id_parameters: ["PROLIFIC_PID"] }));
  const person = await Person.arrive(browser, server, "linked");
  await person.page.goto(`${server.base}/s/linked?PROLIFIC_PID=abc&utm_source=letter`);
  const entering = person.page.waitForRequest((request) => request.method() === "POST" && request.url().endsWith("/participants"));
  await person.press("I agree and want to take part");
  assert.deepEqual((await entering).postDataJSON().parameters, { PROLIFIC_PID: "abc" });
  await person.context.close();
});
