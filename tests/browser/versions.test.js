// A study made in the researcher's page, looked at, opened, changed and closed, and what that means for
// those who are amid it.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { violations } from "./axe.js";
import { launch, Person } from "./person.js";
import { Server } from "./server.js";
import { small_study } from "./study.js";

let server;
let browser;
let page;

before(async () => {
  server = await Server.start();
  await server.call("POST", "/api/v1/studies", small_study("template", {
    grace_minutes: 0,
    practice: { scene: "boxes", techniques: ["reference", "none"] },
    completion: { code: "SHADE", over_quota: { code: "LATE", url: "" } },
  }));
  browser = await launch();
  page = await (await browser.newContext({ viewport: { width: 1440, height: 1000 } })).newPage();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

test("the laboratory asks for its token, and says when it is the wrong one", async () => {
  const reply = await page.goto(`${server.base}/lab`);
  assert.equal(reply.status(), 401);
  assert.deepEqual(await violations(page), []);
  await page.getByLabel("Researcher's token").fill("guess");
  await page.getByRole("button", { name: "Sign in" }).click();
  await page.getByText("this is not the researcher's token").waitFor();
  await page.getByLabel("Researcher's token").fill(server.token);
  await page.getByRole("button", { name: "Sign in" }).click();
  await page.getByRole("heading", { name: "Studies" }).waitFor();
  assert.ok(!page.url().includes(server.token));
});

test("a study is written from a template, its faults are told all at once, and it is stored", async () => {
  await page.getByLabel("From a template").selectOption({ label: "Shadows (template)" });
  await page.getByRole("button", { name: "Write a copy" }).click();
  const text = page.getByLabel("Study file (JSON)");
  const study = JSON.parse(await text.inputValue());
  assert.equal(study.id, "template-copy");
  study.id = "made-here";
  const wrong = JSON.stringify({ ...study, techniques: ["none", "shadow-mop"], pages: [{ scene: "half-plan" }, { scene: "boxes" }] }, null, 2);
  await text.fill(wrong);
  await page.getByRole("button", { name: "Check and store as draft" }).click();
  await page.getByText("things are wrong with this study").waitFor();
  const faults = await page.locator(".problems li code").allInnerTexts();
  assert.deepEqual(faults.sort(), ["pages[0].scene", "techniques[1]"]);
  // Each fault leads to its line, where what is meant is selected and in view.
  assert.equal(await text.getAttribute("aria-invalid"), "true");
  for (const [field, value] of [["techniques[1]", '"shadow-mop"'], ["pages[0].scene", '"half-plan"']]) {
    const line = wrong.slice(0, wrong.indexOf(value)).split("\n").length;
    await page.locator(".problems li", { hasText: field }).getByRole("button", { name: `line ${line}`, exact: true }).click();
    const shown = await text.evaluate((area) => ({ focused: document.activeElement === area,
      selected: area.value.slice(area.selectionStart, area.selectionEnd),
      at: (area.value.slice(0, area.selectionStart).split("\n").length - 0.5) * (area.scrollHeight / area.value.split("\n").length) - area.scrollTop,
      height: area.clientHeight }));
    assert.ok(shown.focused);
    assert.equal(shown.selected, value);
    assert.ok(shown.at > 0 && shown.at < shown.height, JSON.stringify(shown));
  }
  assert.deepEqual(await violations(page), []);
  // What is no JSON is told with its line, and loses nothing.
  const broken = JSON.stringify(study, null, 2).replace('"languages"', "languages");
  await text.fill(broken);
  await page.getByRole("button", { name: "Check and store as draft" }).click();
  await page.locator(".problems").getByRole("button", { name: `line ${broken.split("\n").findIndex((line) => /^\s*languages/.test(line)) + 1}`, exact: true }).waitFor();
  assert.equal(await text.inputValue(), broken);
  await text.fill(JSON.stringify(study));
  await page.getByRole("button", { name: "Check and store as draft" }).click();
  await page.getByRole("heading", { name: "Shadows" }).waitFor();
  assert.match(page.url(), /#study\/made-here\/1$/);
  assert.deepEqual(await violations(page), []);
});

test("a draft is looked at with its pictures, and what is answered there is never counted", async () => {
  const opened = page.context().waitForEvent("page");
  await page.getByRole("link", { name: "Preview" }).click();
  const preview = await opened;
  await preview.getByRole("button", { name: "I agree and want to take part" }).click();
  await preview.getByRole("button", { name: "Show the first page" }).click();
  await preview.locator(".pick img").first().waitFor({ timeout: 120_000 });
  await preview.getByText("Preview: not counted").waitFor();
  await preview.close();
  const { participants } = await server.call("GET", "/api/v1/studies/made-here");
  assert.deepEqual(participants, { entered: 0, completed: 0, withdrawn: 0, tests: 1 });
});

let amid;

test("the practice page tells which order was meant", async () => {
  await page.getByRole("button", { name: "Render the pictures and publish" }).click();
  await page.getByRole("link", { name: /\/s\/made-here$/ }).waitFor({ timeout: 120_000 });
  amid = await Person.arrive(browser, server, "made-here");
  await amid.enter();
  await amid.click_onto("A", 0);
  await amid.click_onto("B", 1);
  await amid.confirm();
  const heading = amid.page.getByRole("heading", { level: 1 });
  await heading.filter({ hasText: /order (that )?is meant/ }).waitFor();
  const first_said = await heading.innerText();
  assert.deepEqual(await violations(amid.page), []);
  // The other way round gets the other verdict.
  await amid.press("Practise again");
  await amid.see_page(0);
  await amid.click_onto("A", 1);
  await amid.click_onto("B", 0);
  await amid.confirm();
  await heading.filter({ hasText: /order (that )?is meant/ }).waitFor();
  assert.notEqual(await heading.innerText(), first_said);
  await amid.press("Continue");
  await amid.see_page(1);
});

test("a draft stands beside the open version, which goes on taking people", async () => {
  const document = await server.call("GET", "/api/v1/studies/made-here/study.json");
  await server.call("POST", "/api/v1/studies", { ...document, quota: 1 });
  await page.goto(`${server.base}/lab#studies`);
  await page.getByText("with a draft of version 2").waitFor();
  await page.locator(".studies .card", { hasText: "made-here" }).getByRole("link").click();
  const rows = page.locator(".versions tbody tr");
  await rows.nth(1).waitFor();
  assert.match(await rows.nth(0).innerText(), /Draft/);
  assert.match(await rows.nth(1).innerText(), /Open/);
  const late = await Person.arrive(browser, server, "made-here");
  await late.button("I agree and want to take part").waitFor();
  await late.context.close();
  assert.deepEqual(await violations(page), []);
});

test("closing is asked about, and those who are too late are told what was kept", async () => {
  await amid.answer({ A: 0, B: 1, C: 2 });
  await amid.see_page(2);
  await page.getByRole("button", { name: "Close the study" }).click();
  await page.getByText("One person has entered and not finished").waitFor();
  assert.deepEqual(await violations(page), []);
  await page.getByRole("button", { name: "Cancel" }).click();
  assert.equal((await server.call("GET", "/api/v1/studies/made-here?version=1")).status, "open");
  await page.getByRole("button", { name: "Close the study" }).click();
  await page.getByRole("button", { name: "Close", exact: true }).click();
  await page.locator(".versions tbody tr").nth(1).getByText("Closed", { exact: true }).waitFor();
  await amid.answer({ A: 0, B: 1, C: 2 });
  await amid.page.getByRole("heading", { name: "This survey is over" }).waitFor();
  assert.match(await amid.page.locator("main").innerText(), /2 of 3 pages are kept/);
  assert.deepEqual(await violations(amid.page), []);
});

test("a version that was closed opens again, and people finish where they were", async () => {
  await page.getByRole("button", { name: "Open again" }).click();
  await page.locator(".versions tbody tr").nth(1).getByText("Open", { exact: true }).waitFor();
  await amid.open();
  await amid.see_page(2);
  await amid.confirm();
  assert.equal(await amid.completion_code(), "SHADE");
  await amid.context.close();
});

test("participants stand with their flags and what happened when, are taken out and taken back", async () => {
  await page.locator(".versions tbody tr").nth(1).getByRole("link", { name: "Participants" }).click();
  await page.getByRole("heading", { name: "Participants of made-here, version 1" }).waitFor();
  const row = page.locator(".people tbody tr", { hasText: "completed" });
  await row.getByText("Timeline").click();
  assert.match(await row.innerText(), /entered[\s\S]*practice 1 \(practice\)[\s\S]*finished/);
  await row.getByRole("button", { name: "Take out" }).click();
  await page.getByLabel("Reason, kept with the decision").fill("a test of the page");
  await page.locator("dialog").getByRole("button", { name: "Take out" }).click();
  await row.locator("p", { hasText: "taken out: a test of the page" }).waitFor();
  assert.deepEqual(await violations(page), []);
  assert.ok((await server.responses("made-here")).every((one) => one.included === "FALSE"));
  await row.getByRole("button", { name: "Take back" }).click();
  await page.getByLabel("Reason, kept with the decision").fill("it was a test");
  await page.locator("dialog").getByRole("button", { name: "Take back" }).click();
  await row.getByRole("button", { name: "Take out" }).waitFor();
  assert.ok((await server.responses("made-here")).every((one) => one.included === "TRUE"));
});

test("the code for phones holds the address of the study", async () => {
  await page.goto(`${server.base}/lab#study/made-here`);
  await page.getByText("QR code", { exact: true }).click();
  const size = await page.locator(".qr img").evaluate(async (image) => {
    await image.decode();
    return image.naturalWidth;
  });
  assert.ok(size > 0);
});

test("who comes when the study has enough people gets the code for that", async () => {
  await page.getByRole("button", { name: "Render the pictures and publish" }).click();
  await page.locator("dialog").getByRole("button", { name: "Publish" }).click();
  await page.locator(".versions tbody tr").nth(0).getByText("Open", { exact: true }).waitFor({ timeout: 120_000 });
  const person = await Person.arrive(browser, server, "made-here");
  await person.enter();
  await person.click_onto("A", 0);
  await person.click_onto("B", 1);
  await person.confirm();
  await person.press("Continue");
  for (const position of [1, 2]) {
    await person.see_page(position);
    await person.answer({ A: 0, B: 1, C: 2 });
  }
  assert.equal(await person.completion_code(), "SHADE");
  await person.context.close();
  const late = await Person.arrive(browser, server, "made-here");
  await late.page.getByRole("heading", { name: /takes no more participants/ }).waitFor();
  assert.equal(await late.completion_code(), "LATE");
  await late.context.close();
});

test("a draft is deleted after a question", async () => {
  await page.goto(`${server.base}/lab#study/template`);
  await page.getByRole("button", { name: "Delete the draft" }).click();
  await page.locator("dialog").getByRole("button", { name: "Delete" }).click();
  await page.getByRole("heading", { name: "Studies" }).waitFor();
  const { studies } = await server.call("GET", "/api/v1/studies");
  assert.ok(!studies.some(({ id }) => id === "template"));
});
