import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, Person } from "./person.js";
import { Server } from "./server.js";
import { small_study } from "./study.js";

const study = "exact";
const ratios = [1, 1.1, 1.25, 1.5, 1.75, 2.625];
let server;
let browser;
let small;
let large;
let canvas;  // a page that decodes and makes PNG

before(async () => {
  server = await Server.start();
  await server.publish(small_study(study, { pages: [{ scene: "half-plane" }] }));
  browser = await launch();
  canvas = await (await browser.newContext()).newPage();
  small = await noise(101, 67);
  large = await noise(1101, 1403);
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

/// A PNG in which no pixel looks like its neighbours: whatever blends, drops or doubles one is seen.
async function noise(width, height) {
  const url = await canvas.evaluate(([columns, rows]) => {
    const element = Object.assign(document.createElement("canvas"), { width: columns, height: rows });
    const drawing = element.getContext("2d");
    const image = drawing.createImageData(columns, rows);
    let state = 1;
    for (let at = 0; at < image.data.length; ++at) {
      state = (state * 48271) % 2147483647;
      image.data[at] = at % 4 === 3 ? 255 : state & 255;
    }
    drawing.putImageData(image, 0, 0);
    return element.toDataURL("image/png");
  }, [width, height]);
  return Buffer.from(url.split(",")[1], "base64");
}

const address_of = (png) => `data:image/png;base64,${png.toString("base64")}`;

/// Counts pixels of a screenshot that are not those of a picture whose top left corner is at `corner`,
/// each repeated `zoom` times, as far as they lie within `limits`.
function differences(shown, expected, corner, limits, zoom) {
  return canvas.evaluate(async ([screenshot, picture, [left, top], [right, bottom], times]) => {
    const decode = async (source) => {
      const image = new Image();
      image.src = source;
      await image.decode();
      const drawing = new OffscreenCanvas(image.naturalWidth, image.naturalHeight).getContext("2d");
      drawing.drawImage(image, 0, 0);
      const { data, width, height } = drawing.getImageData(0, 0, image.naturalWidth, image.naturalHeight);
      return { colours: new Uint32Array(data.buffer), width, height };
    };
    const [screen, own] = [await decode(screenshot), await decode(picture)];
    const count = { compared: 0, wrong: 0 };
    for (let y = Math.max(top, 0); y < Math.min(top + own.height * times, bottom); ++y) {
      for (let x = Math.max(left, 0); x < Math.min(left + own.width * times, right); ++x) {
        const at = Math.floor((y - top) / times) * own.width + Math.floor((x - left) / times);
        ++count.compared;
        if (screen.colours[y * screen.width + x] !== own.colours[at]) ++count.wrong;
      }
    }
    return count;
  }, [address_of(shown), address_of(expected), corner, limits, zoom]);
}

/// Compares what is on the screen with the picture's own pixels. Returns how many were compared.
async function compare(person, png, zoom, what) {
  const { corner, limits } = await person.page.evaluate(async () => {
    // The picture is there, and what a changed window calls for has been done and drawn.
    await document.querySelector(".viewer-stage img").decode();
    for (let frame = 0; frame < 2; ++frame) await new Promise(requestAnimationFrame);
    const image = document.querySelector(".viewer-stage img").getBoundingClientRect();
    const stage = document.querySelector(".viewer-stage");
    return { corner: [image.left, image.top].map((at) => Math.round(at * devicePixelRatio)),
      limits: [stage.clientWidth, stage.clientHeight].map((at) => Math.floor(at * devicePixelRatio)) };
  });
  const { compared, wrong } = await differences(await person.page.screenshot(), png, corner, limits, zoom);
  assert.equal(wrong, 0, `${what}: ${wrong} of ${compared} pixels differ`);
  return compared;
}

async function enlarge(ratio, png, viewport) {
  const person = await Person.arrive(browser, server, study, { deviceScaleFactor: ratio, viewport });
  await person.page.route(/\/pictures\/0$/, (route) => route.fulfill({ body: png, contentType: "image/png" }));
  await person.enter();
  await person.press("Enlarge Picture A");
  await person.page.locator(".viewer-stage").blur();
  return person;
}

for (const ratio of ratios) {
  test(`at ${ratio} device pixels to a CSS pixel, an enlarged picture's pixels are the screen's`, async () => {
    const person = await enlarge(ratio, small, { width: 903, height: 701 });
    assert.equal(await compare(person, small, 1, "actual size"), 101 * 67);
    await person.press("Zoom in");
    assert.equal(await compare(person, small, 2, "doubled"), 4 * 101 * 67);
    await person.page.setViewportSize({ width: 850, height: 644 });
    assert.equal(await compare(person, small, 2, "in a smaller window"), 4 * 101 * 67);
    // The server's own picture, without the noise.
    await person.page.getByRole("button", { name: "Picture B", exact: true }).click();
    await person.press("Zoom out");
    const address = await person.page.locator(".viewer-stage img").getAttribute("src");
    const reply = await person.context.request.get(new URL(address, server.base).href);
    assert.equal(await compare(person, await reply.body(), 1, "the server's picture"), 128 * 128);
    await person.context.close();

    const panned = await enlarge(ratio, large, { width: 403, height: 501 });
    assert.ok((await compare(panned, large, 1, "larger than the window")) > 10_000);
    await panned.page.locator(".viewer-stage").evaluate((stage) => stage.scrollTo(40, 80));
    assert.ok((await compare(panned, large, 1, "scrolled")) > 10_000);
    await panned.context.close();
  });
}
