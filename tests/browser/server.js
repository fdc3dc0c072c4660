// Starts the real server on a free port with an empty data folder, and talks to its API.

import { spawn } from "node:child_process";
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import path from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { fileURLToPath } from "node:url";

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../..");
const program = process.env.PENUMBRA ?? path.join(root, "build/penumbra");
const start_ms = 60_000;
const publish_ms = 300_000;

export class Server {
  static async start(served = program) {
    const server = new Server();
    server.data = await mkdtemp(path.join(tmpdir(), "penumbra-browser-"));
    server.process = spawn(served, ["serve", "--port", "0", "--ops-port", "0", "--data", server.data],
      { stdio: ["ignore", "pipe", "pipe"] });
    server.log = "";
    server.process.stderr.on("data", (text) => (server.log += text));
    const found = await server.address();
    server.base = found.origin;
    server.token = found.searchParams.get("token");
    return server;
  }

  /// The researcher's URL, from standard output.
  address() {
    return new Promise((resolve, reject) => {
      let output = "";
      const timer = setTimeout(() => reject(new Error(`no address after ${start_ms} ms: ${output}${this.log}`)), start_ms);
      this.process.once("error", reject);
      this.process.once("exit", (status) => reject(new Error(`${program} ended with ${status}: ${output}${this.log}`)));
      this.process.stdout.on("data", (text) => {
        output += text;
        const url = /https?:\/\/\S+\/lab\?token=\S+/.exec(output);
        if (!url || !output.includes("\n", url.index)) return;
        clearTimeout(timer);
        resolve(new URL(url[0]));
      });
    });
  }

  async stop() {
    if (this.process.exitCode === null) {
      const ended = new Promise((resolve) => this.process.once("exit", resolve));
      this.process.kill("SIGTERM");
      await ended;
    }
    await rm(this.data, { recursive: true, force: true });
  }

  /// As the researcher.
  async call(method, at, body = undefined) {
    const reply = await fetch(this.base + at, {
      method,
      headers: { Authorization: `Bearer ${this.token}`, "Content-Type": "application/json" },
      body: body === undefined ? undefined : JSON.stringify(body),
    });
    const text = await reply.text();
    if (!reply.ok) throw new Error(`${method} ${at}: ${reply.status} ${text}`);
    return reply.headers.get("content-type")?.includes("json") ? JSON.parse(text) : text;
  }

  async publish(study) {
    await this.call("POST", "/api/v1/studies", study);
    await this.call("POST", `/api/v1/studies/${study.id}/publish`);
    const deadline = Date.now() + publish_ms;
    for (;;) {
      const state = await this.call("GET", `/api/v1/studies/${study.id}`);
      if (state.status === "open") return;
      if (state.progress.error) throw new Error(`publishing failed: ${JSON.stringify(state.progress.error)}`);
      if (Date.now() > deadline) throw new Error(`still ${state.status} after ${publish_ms} ms`);
      await sleep(200);
    }
  }

  /// Lets people with known preferences take part in a study, published or not.
  async simulate(study, ...options) {
    const file = path.join(this.data, `${study.id}.json`);
    await writeFile(file, JSON.stringify(study));
    const url = `${this.base}/lab?token=${this.token}`;
    const simulation = spawn(program, ["simulate-study", file, "--url", url, ...options], { stdio: ["ignore", "ignore", "pipe"] });
    let said = "";
    simulation.stderr.on("data", (text) => (said += text));
    const status = await new Promise((resolve) => simulation.once("exit", resolve));
    if (status !== 0) throw new Error(`simulate-study ended with ${status}: ${said}`);
  }

  /// Rows of responses.csv as objects. The cells asked for here hold no commas or quotes.
  async responses(study) {
    const text = await this.call("GET", `/api/v1/studies/${study}/responses.csv`);
    const [header, ...lines] = text.split("\r\n").filter((line) => line !== "");
    const names = header.split(",");
    return lines.map((line) => Object.fromEntries(line.split(",").map((cell, index) => [names[index], cell])));
  }
}
