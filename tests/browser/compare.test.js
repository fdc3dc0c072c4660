import assert from "node:assert/strict";
import path from "node:path";
import { after, before, test } from "node:test";
import { violations } from "./axe.js";
import { launch } from "./person.js";
import { Server } from "./server.js";

let server;
let browser;
let page;

before(async () => {
  server = await Server.start();
  browser = await launch();
  page = await (await browser.newContext({ viewport: { width: 1440, height: 1000 } })).newPage();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

const draw = async () => {
  await page.getByRole("button", { name: "Draw both" }).click();
  await page.locator("form button:enabled", { hasText: "Draw both" }).waitFor({ timeout: 120_000 });
  assert.equal(await page.locator(".bench-form > .problems").innerText(), "");
};

/// Where the pictures lie in their panes: [zoom, across, down] of each.
const places = () => page.locator(".pane img").evaluateAll((images) => images.map((image) => {
  const [shown, pane] = [image.getBoundingClientRect(), image.parentElement.getBoundingClientRect()];
  return [shown.width / pane.width, (shown.left - pane.left) / pane.width, (shown.top - pane.top) / pane.height]
    .map((number) => Number(number.toFixed(2)));
}));

/// Mean of the first picture's red, green and blue.
const brightness = () => page.locator(".pane img").first().evaluate(async (image) => {
  await image.decode();
  const canvas = new OffscreenCanvas(image.naturalWidth, image.naturalHeight);
  const pen = canvas.getContext("2d");
  pen.drawImage(image, 0, 0);
  const { data } = pen.getImageData(0, 0, canvas.width, canvas.height);
  return data.reduce((sum, value) => sum + value, 0) / data.length;
});

test("two techniques stand beside the reference and their errors, with numbers of both", async () => {
  await page.goto(`${server.base}/lab?token=${server.token}#compare`);
  await page.getByLabel("Scene", { exact: true }).selectOption("half-plane");
  await page.locator(".lights legend").first().waitFor({ state: "attached" });
  await page.getByLabel("Technique A").selectOption("none");
  await page.getByLabel("Technique B").selectOption("shadow-map");
  await page.getByLabel("Width and height, pixels").fill("96");
  await page.getByLabel("Light samples").fill("16");
  assert.deepEqual(await violations(page), []);
  await draw();
  const captions = await page.locator(".lens figcaption").allInnerTexts();
  assert.deepEqual(captions.map((text) => text.split(":")[0]), ["A", "B", "Reference", "Error of A", "Error of B"]);
  for (const image of await page.locator(".pane img").all())
    assert.equal(await image.evaluate(async (element) => (await element.decode(), element.naturalWidth)), 96);
  const errors = await page.getByRole("row", { name: /rms_y/ }).locator("td").allInnerTexts();
  assert.ok(Number(errors[0]) > Number(errors[1]) && Number(errors[1]) > 0, errors.join());
  assert.equal((await page.getByRole("row", { name: /Frame time, median/ }).locator("td").allInnerTexts()).length, 2);
  assert.deepEqual(await violations(page), []);
});

test("all pictures are zoomed and moved together, by keys and by wheel", async () => {
  await page.locator(".lens").focus();
  await page.keyboard.press("+");
  await page.keyboard.press("ArrowRight");
  const near = await places();
  assert.deepEqual(near[0], [1.5, -0.35, -0.25]);
  for (const place of near) assert.deepEqual(place, near[0]);
  await page.keyboard.press("0");
  const box = await page.locator(".pane").nth(1).boundingBox();
  // The point under the pointer, a quarter in from the left and from the top, stays where it is.
  await page.mouse.move(box.x + box.width / 4, box.y + box.height / 4);
  await page.mouse.wheel(0, -100);
  for (const [zoom, across, down] of await places())
    assert.ok(zoom === 1.5 && Math.abs(across + 0.125) < 0.01 && Math.abs(down + 0.125) < 0.01, `${zoom} ${across} ${down}`);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 4 - 0.2 * box.width, box.y + box.height / 4);
  await page.mouse.up();
  for (const [, across] of await places()) assert.ok(Math.abs(across + 0.325) < 0.02, String(across));
  await page.keyboard.press("0");
});

test("F shows B in A's place and back", async () => {
  const names = () => page.locator(".lens figcaption").allInnerTexts();
  const sources = () => page.locator(".pane img").evaluateAll((images) => images.slice(0, 2).map(({ src }) => src));
  const [before_names, before_sources] = [await names(), await sources()];
  await page.locator(".lens").focus();
  await page.keyboard.press("f");
  assert.deepEqual((await names()).slice(0, 2), [before_names[1], before_names[0]]);
  assert.deepEqual(await sources(), [before_sources[1], before_sources[0]]);
  await page.keyboard.press("f");
  assert.deepEqual(await names(), before_names);
});

test("lights and parameters are moved by sliders", async () => {
  await page.getByText("Lights", { exact: true }).click();
  const before_move = await brightness();
  const slider = page.locator(".lights input").nth(1);
  await slider.focus();
  for (let press = 0; press < 20; ++press) await page.keyboard.press("ArrowRight");
  await page.getByText("Parameters of B").click();
  const size = page.getByRole("spinbutton", { name: /^map size/ });
  const first = Number(await size.inputValue());
  await page.getByRole("slider", { name: "map size, slider" }).focus();
  await page.keyboard.press("ArrowLeft");
  assert.ok(Number(await size.inputValue()) < first);
  await draw();
  assert.notEqual(await brightness(), before_move);
  assert.deepEqual(await violations(page), []);
});

for (const [width, height, scheme] of [[1440, 1000, "light"], [768, 1024, "dark"], [360, 740, "light"]]) {
  test(`the page fits ${width} pixels, ${scheme}`, async () => {
    await page.emulateMedia({ colorScheme: scheme });
    await page.setViewportSize({ width, height });
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    assert.deepEqual(await violations(page), []);
    if (process.env.SCREENSHOTS)
      await page.screenshot({ path: path.join(process.env.SCREENSHOTS, `compare-${width}.png`), fullPage: true });
  });
}
