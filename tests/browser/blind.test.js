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

const addresses = () => [...new Set(pictures().map((reply) => reply.url()))];
const bytes_of = async (address, accept) => Buffer.from(await (await fetch(address, { headers: { Accept: accept } })).arrayBuffer());

test("pictures carry their pixels and no text, as PNG and as WebP", async () => {
  for (const address of addresses()) {
    const png = await bytes_of(address, "image/png");
    assert.deepEqual(new Set(chunks(png)), new Set(["IHDR", "IDAT", "IEND"]));
    const webp = await bytes_of(address, "image/webp");
    // One lossless chunk that fills the file (WebP Container Specification).
    assert.equal(webp.toString("latin1", 0, 4) + webp.toString("latin1", 8, 16), "RIFFWEBPVP8L");
    const length = webp.readUInt32LE(16);
    assert.equal(webp.length, 20 + length + (length % 2));
    assert.ok(webp.length < png.length, `${webp.length} < ${png.length}`);
  }
});

test("Chromium gets WebP and decodes it to the pixels of the PNG", async () => {
  for (const reply of pictures()) assert.equal(reply.headers()["content-type"], "image/webp");
  const different = await person.page.evaluate((all) => Promise.all(all.map(async (address) => {
    const pixels = async (accept) => {
      const blob = await (await fetch(address, { headers: { Accept: accept }, cache: "no-store" })).blob();
      const picture = await createImageBitmap(blob);
      const paper = new OffscreenCanvas(picture.width, picture.height).getContext("2d");
      paper.drawImage(picture, 0, 0);
      return { type: blob.type, width: picture.width, data: paper.getImageData(0, 0, picture.width, picture.height).data };
    };
    const [png, webp] = [await pixels("image/png"), await pixels("image/webp")];
    if (png.type !== "image/png" || webp.type !== "image/webp" || png.width !== 128) return -1;
    return png.data.reduce((count, value, index) => count + (value !== webp.data[index]), 0);
  })), addresses());
  assert.deepEqual(different, addresses().map(() => 0));
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
