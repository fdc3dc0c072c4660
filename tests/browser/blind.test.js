import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, Person } from "./person.js";
import { Server } from "./server.js";
import { small_study, techniques } from "./study.js";

const study = "blind";
let server;
let browser;
let person;

before(async () => {
  server = await Server.start();
  await server.publish(small_study(study));
  browser = await launch();
  person = await Person.arrive(browser, server, study);
  person.replies = [];
  person.context.on("response", (response) => person.replies.push(response));
  await person.enter();
  await person.answer({ A: 0, B: 1, C: 2 });
  await person.see_page(1);
  await person.answer({ A: 0, B: 1, C: 2 });
  await person.completion_code();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

const pictures = () => person.replies.filter((reply) => reply.request().resourceType() === "image" && reply.url().includes("/pages/"));

/// Names of the chunks of a PNG file (PNG specification, 5.3).
function chunks(bytes) {
  const names = [];
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) names.push(bytes.toString("latin1", at + 4, at + 8));
  return names;
}

test("no request leaves for anybody else", () => {
  assert.ok(person.requests.length > 10);
  assert.deepEqual(person.requests.map((request) => request.url()).filter((url) => !url.startsWith(`${server.base}/`)), []);
});

test("the pages break no rule of their own content security policy", () => {
  assert.deepEqual(person.faults, []);
});

test("addresses and headers of pictures tell nothing about how they were made", async () => {
  assert.ok(pictures().length >= 6);
  const shapes = new Set();
  for (const reply of pictures()) {
    for (const word of [...techniques, "half-plane", "boxes", "map"]) assert.ok(!reply.url().includes(word), reply.url());
    const headers = { ...(await reply.allHeaders()) };
    assert.equal(headers.etag, undefined);
    assert.equal(headers["last-modified"], undefined);
    for (const name of ["content-length", "date", "keep-alive"]) delete headers[name];
    shapes.add(JSON.stringify(headers));
  }
  assert.equal(shapes.size, 1);
});

test("pictures carry their pixels and no text", async () => {
  const addresses = [...new Set(pictures().map((reply) => reply.url()))];
  for (const address of addresses) {
    const names = chunks(Buffer.from(await (await fetch(address)).arrayBuffer()));
    assert.ok(names.includes("IDAT"));
    for (const name of ["tEXt", "zTXt", "iTXt", "tIME", "eXIf"]) assert.ok(!names.includes(name), name);
  }
});

test("nothing that the server says to the page names a technique or scene", async () => {
  const texts = person.replies.filter((reply) => reply.url().includes("/api/v1/") || reply.url().endsWith("/welcome"))
    .filter((reply) => reply.headers()["content-type"]?.includes("json"));
  assert.ok(texts.length >= 4);
  for (const reply of texts) {
    const text = await reply.text();
    for (const word of ["shadow-map", "half-plane", "\"none\"", "\"boxes\""]) assert.ok(!text.includes(word), `${word} in ${reply.url()}`);
  }
});

test("no digit stands on the page where pictures are ranked", async () => {
  const other = await Person.arrive(browser, server, study);
  await other.enter();
  await other.click_onto("A", 1);
  const said = await other.page.evaluate(() => [document.getElementById("main").innerText, document.getElementById("live").innerText,
    ...[...document.querySelectorAll("main [aria-label]")].map((element) => element.getAttribute("aria-label")),
    ...[...document.querySelectorAll("main img")].map((element) => element.alt)].join("\n"));
  assert.match(said, /Picture A/);
  assert.doesNotMatch(said, /\d/);
  await other.context.close();
});

test("pictures of two people have no address in common", async () => {
  const other = await Person.arrive(browser, server, study);
  await other.enter();
  const addresses = await other.page.locator(".pick img").evaluateAll((all) => all.map((image) => image.src));
  const known = new Set(pictures().map((reply) => reply.url()));
  assert.equal(addresses.length, 3);
  assert.deepEqual(addresses.filter((address) => known.has(address)), []);
  for (const address of addresses) assert.equal((await fetch(address)).status, 200);
  await other.context.close();
});
