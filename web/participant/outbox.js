// Answers on their way to the server: oldest first, one at a time, again and again until the server
// has answered. An item leaves the outbox only then, so a reload in between sends it once more under
// the same id, which the server takes for the same answer.

import { put, sleep } from "/assets/shared/http.js";
import { alone } from "./storage.js";

const first_pause_ms = 500;
const longest_pause_ms = 15_000;

export class Outbox extends EventTarget {
  constructor(storage) {
    super();
    this.storage = storage;
    this.state = "saved";  // saved, sending, waiting (no connection), refused
    this.refusal = null;
    this.running = null;
    this.wake = () => {};
    addEventListener("online", () => this.flush());
    document.addEventListener("visibilitychange", () => {
      if (document.visibilityState === "visible") this.flush();
    });
  }

  tell(state, refusal = null) {
    this.state = state;
    this.refusal = refusal;
    this.dispatchEvent(new Event("change"));
  }

  async push(path, body, key, value) {
    await this.storage.push({ path, body }, key, value);
    this.flush();
  }

  /// Starts sending, or cuts a pause between two attempts short. Resolves when nothing is left.
  flush() {
    this.wake();
    this.running ??= alone("outbox", () => this.drain()).finally(() => {
      this.running = null;
    });
    return this.running;
  }

  async drain() {
    let pause_ms = first_pause_ms;
    for (;;) {
      const [item] = await this.storage.items();
      if (!item) break;
      if (this.state !== "waiting") this.tell("sending");
      try {
        await put(item.path, item.body);
        await this.storage.drop(item.sequence);
        pause_ms = first_pause_ms;
      } catch (error) {
        if (!error.passing) {
          // The server has read it and will not have it: trying again changes nothing. One that does
          // not know the person may be a server whose data is being restored: the answer is kept.
          if (error.status !== 404) await this.storage.drop(item.sequence);
          this.tell("refused", error);
          throw error;
        }
        this.tell("waiting");
        await this.pause(Math.max(pause_ms, 1000 * (error.retry_after_s ?? 0)));
        pause_ms = Math.min(2 * pause_ms, longest_pause_ms);
      }
    }
    this.tell("saved");
  }

  async pause(ms) {
    // Spread over a quarter, so that a crowd does not come back at one instant after a restart.
    const spread = ms * (0.75 + 0.25 * Math.random());
    await Promise.race([sleep(spread), new Promise((resolve) => (this.wake = resolve))]);
    this.wake = () => {};
  }
}
