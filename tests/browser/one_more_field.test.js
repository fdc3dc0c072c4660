// The program with a made-up field of requests, declared in one place (tests/one_more_field): it is found
// wherever people meet fields.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import path from "node:path";
import { after, before, test } from "node:test";
import { violations } from "./axe.js";
import { launch } from "./person.js";
import { Server } from "./server.js";
import { small_study } from "./study.js";

const program = process.env.ONE_MORE_FIELD_PROGRAM
  ?? path.resolve(import.meta.dirname, "../../build/tests/one_more_field/penumbra_one_more_field");
const allowed = "film_grain must be an integer from 2 to 8, not 9";

let server;
let browser;

const run = (...options) => spawnSync(program, options, { encoding: "utf8" });

before(async () => {
  server = await Server.start(program);
  browser = await launch();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

const post = (at, body) => fetch(server.base + at, {
  method: "POST",
  headers: { Authorization: `Bearer ${server.token}`, "Content-Type": "application/json" },
  body: JSON.stringify(body),
});

/// What the server says of a body that it refuses.
async function refusal(at, body) {
  const reply = await post(at, body);
  assert.equal(reply.status, 400);
  return (await reply.json()).error;
}

test("it is an option of every command that takes a request, with its help", () => {
  for (const command of ["render", "measure", "plan"])
    assert.match(run(command, "--help").stdout, /--film-grain TEXT\s+Grains per pixel \[3\]/, command);
  const refused = run("plan", "boxes", "none", "--film-grain", "9");
  assert.equal(refused.status, 2);
  assert.ok(refused.stderr.includes(allowed), refused.stderr);
});

test("it is read from JSON and from a query, and is part of the canonical request", async () => {
  const small = { scene: "half-plane", technique: "none", width: 16, height: 16 };
  const ids = new Set();
  for (const [given, grain] of [[{}, 3], [{ film_grain: 3 }, 3], [{ film_grain: 8 }, 8]]) {
    const { id, request } = await server.call("POST", "/api/v1/renders", { ...small, ...given });
    assert.equal(request.film_grain, grain);
    ids.add(id);
  }
  assert.equal(ids.size, 2);
  const error = await refusal("/api/v1/renders", { ...small, film_grain: 9 });
  assert.deepEqual([error.field, error.message], ["film_grain", allowed]);
  const reply = await fetch(`${server.base}/api/v1/plan?scene=half-plane&technique=none&film_grain=9`);
  assert.equal((await reply.json()).error.message, allowed);
});

test("it is in the API's document", async () => {
  const { components, paths } = await server.call("GET", "/openapi.json");
  const { "x-order": order, ...schema } = components.schemas.RenderRequest.properties.film_grain;
  assert.equal(order, Object.keys(components.schemas.RenderRequest.properties).length - 1);
  assert.deepEqual(schema, { type: "integer", description: "Grains per pixel.", minimum: 2, maximum: 8, default: 3,
    examples: [4], "x-label": "Film grain" });
  for (const at of ["/api/v1/image", "/api/v1/plan"])
    assert.ok(paths[at].get.parameters.some(({ name, schema: { maximum } = {} }) => name === "film_grain" && maximum === 8), at);
});

test("a study's schema knows it, and its pictures are drawn with it", async () => {
  const study = small_study("grain", { techniques: ["none", "shadow-map"], pages: [{ scene: "half-plane" }] });
  const refused = await refusal("/api/v1/studies", { ...study, picture: { film_grain: 9 } });
  assert.equal(refused.field, "picture.film_grain");
  const unknown = await refusal("/api/v1/studies", { ...study, picture: { film_grane: 4 } });
  assert.match(unknown.message, /known are .*film_grain/);
  const picture = { ...study.picture, width: 16, height: 16 };
  await server.publish({ ...study, picture });
  // Pictures that the study had drawn are there at once: those with the study's own default.
  for (const [film_grain, status] of [[5, 200], [4, 202]]) {
    const reply = await post("/api/v1/renders", { scene: "half-plane", technique: "none", ...picture, film_grain });
    assert.equal(reply.status, status, `${film_grain}`);
  }
});

test("the bench and the comparison have an input for it, and send what it says", async () => {
  for (const [at, button] of [["bench", "Render"], ["compare", "Draw both"]]) {
    const page = await (await browser.newContext()).newPage();
    await page.goto(`${server.base}/lab?token=${server.token}#${at}`);
    const input = page.getByLabel("Film grain");
    await input.waitFor();
    assert.deepEqual([await input.inputValue(), await input.getAttribute("min"), await input.getAttribute("max")], ["3", "2", "8"]);
    assert.deepEqual(await violations(page), []);
    await input.fill("7");
    const asked = page.waitForRequest((request) => request.method() === "POST" && request.url().endsWith("/api/v1/renders"));
    await page.getByRole("button", { name: button }).click();
    assert.equal((await asked).postDataJSON().film_grain, 7, at);
    await page.context().close();
  }
});
