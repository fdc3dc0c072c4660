import assert from "node:assert/strict";
import path from "node:path";
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
  browser = await launch();
  await server.call("POST", "/api/v1/studies", small_study("photographs", { pages: [{ scene: "half-plane" }] }));
  page = await (await browser.newContext({ viewport: { width: 1440, height: 1000 } })).newPage();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

/// A file that the browser itself writes: stripes of 128 by 128 pixels.
const file_of = async (type) => Buffer.from(await page.evaluate(async (kind) => {
  const canvas = new OffscreenCanvas(128, 128);
  const pen = canvas.getContext("2d");
  for (let stripe = 0; stripe < 16; ++stripe) {
    pen.fillStyle = `rgb(${stripe * 16} ${255 - stripe * 16} 40)`;
    pen.fillRect(stripe * 8, 0, 8, 128);
  }
  return [...new Uint8Array(await (await canvas.convertToBlob({ type: kind, quality: 1 })).arrayBuffer())];
}, type));

const screenshot = async (name) => process.env.SCREENSHOTS
  && page.screenshot({ path: path.join(process.env.SCREENSHOTS, `${name}.png`), fullPage: true });

test("pictures of one's own are uploaded in the editor and written into the study", async () => {
  await page.goto(`${server.base}/lab?token=${server.token}#edit/photographs`);
  await page.getByLabel("Study file (JSON)").waitFor();
  await page.getByLabel("Picture files").setInputFiles([
    { name: "My photo.JPEG", mimeType: "image/jpeg", buffer: await file_of("image/jpeg") },
    { name: "notes.png", mimeType: "image/png", buffer: Buffer.from("no picture") },
  ]);
  await page.getByText("notes.png: ").waitFor();
  const [own] = await page.locator(".own-pictures code").allInnerTexts();
  const element = JSON.parse(own);
  assert.equal(element.id, "my-photo");
  await page.getByText("My photo.JPEG, 128 by 128 pixels").waitFor();
  assert.deepEqual(await violations(page), []);
  await page.getByLabel("Study file (JSON)").evaluate((field) => {
    const at = field.value.indexOf('"reference"\n  ]');
    if (at < 0) throw new Error(field.value);
    field.setSelectionRange(at, at);
  });
  await page.getByRole("button", { name: "Write it at the cursor" }).click();
  await page.keyboard.type(", ");
  await screenshot("own-pictures");
  await page.getByRole("button", { name: "Check and store as draft" }).click();
  await page.getByRole("button", { name: "Render the pictures and publish" }).waitFor();
  const { document } = await server.call("GET", "/api/v1/studies/photographs");
  assert.deepEqual(document.techniques, ["none", "shadow-map", element, "reference"]);
});

test("files dropped onto the field are uploaded too", async () => {
  await page.goto(`${server.base}/lab#edit/photographs`);
  await page.getByLabel("Study file (JSON)").waitFor();
  const bytes = [...await file_of("image/webp")];
  const dropped = await page.evaluateHandle((data) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([new Uint8Array(data)], "Dropped one.webp", { type: "image/webp" }));
    transfer.items.add(new File([new Uint8Array(data).slice(0, 40)], "cut.webp", { type: "image/webp" }));
    return transfer;
  }, bytes);
  const field = page.locator("section", { has: page.getByLabel("Picture files") });
  for (const event of ["dragenter", "dragover", "drop"]) await field.dispatchEvent(event, { dataTransfer: dropped });
  await page.getByText("Dropped one.webp, 128 by 128 pixels").waitFor();
  await page.getByText("cut.webp: ").waitFor();
  const { id, picture } = JSON.parse(await page.locator(".own-pictures code").innerText());
  assert.equal(id, "dropped-one");
  assert.equal((await fetch(`${server.base}/api/v1/pictures/${picture}`, { headers: { Authorization: `Bearer ${server.token}` } })).status, 200);
  assert.match(page.url(), /#edit\/photographs$/, "the browser did not open the file instead");
  await page.goto(`${server.base}/lab#study/photographs`);
});

test("a person ranks them among rendered ones, and nothing tells which are which", async () => {
  await page.getByRole("button", { name: "Render the pictures and publish" }).click();
  await page.getByRole("link", { name: /\/s\/photographs$/ }).waitFor({ timeout: 120_000 });
  const person = await Person.arrive(browser, server, "photographs");
  await person.enter();
  const headers = [];
  for (const image of await person.page.locator(".pick img").all()) {
    const shown = await image.evaluate(async (element) => {
      await element.decode();
      return { url: element.src, size: [element.naturalWidth, element.naturalHeight] };
    });
    assert.deepEqual(shown.size, [128, 128]);
    // Bytes 8 to 32 of a PNG: size, depth and kind of its pixels.
    const png = Buffer.from(await (await fetch(shown.url)).arrayBuffer());
    headers.push(png.subarray(8, 29).toString("hex"));
  }
  assert.equal(headers.length, 4);
  assert.equal(new Set(headers).size, 1);
  await person.answer({ A: 0, B: 1, C: 2, D: 3 });
  assert.equal(await person.completion_code(), "SHADE");
  assert.deepEqual(person.faults, []);
  const rows = await server.responses("photographs");
  const { document } = await server.call("GET", "/api/v1/studies/photographs");
  assert.deepEqual(rows.filter((row) => row.own_picture !== "").map((row) => [row.technique, row.own_picture]),
    [["my-photo", document.techniques[2].picture]]);
  await person.context.close();
});

test("the pixels that a person sees are those of the file", async () => {
  const png = await file_of("image/png");
  const upload = await fetch(`${server.base}/api/v1/pictures`, {
    method: "POST", headers: { Authorization: `Bearer ${server.token}` }, body: png });
  const { picture } = await upload.json();
  const [kept, original] = await page.evaluate(async ([name, bytes]) => {
    const pixels = async (blob) => {
      const bitmap = await createImageBitmap(blob);
      const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
      canvas.getContext("2d").drawImage(bitmap, 0, 0);
      return [...canvas.getContext("2d").getImageData(0, 0, bitmap.width, bitmap.height).data].join();
    };
    return [await pixels(await (await fetch(`/api/v1/pictures/${name}`)).blob()),
      await pixels(new Blob([new Uint8Array(bytes)], { type: "image/png" }))];
  }, [picture, [...png]]);
  assert.equal(kept, original);
});
