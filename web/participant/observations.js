// What is recorded beside the ranks, and nothing else about the person.

/// Counts for one page; `earlier` is what a reload kept.
export class Observations {
  constructor(earlier = {}) {
    this.counts = {
      active_ms: earlier.active_ms ?? 0,
      enlargements: earlier.enlargements ?? 0,
      flips: earlier.flips ?? 0,
      blurs: earlier.blurs ?? 0,
      load_failures: earlier.load_failures ?? 0,
      swaps: earlier.swaps ?? 0,
      turns: earlier.turns ?? 0,
    };
    this.views = new Set(earlier.views ?? []);  // of a page that can be turned
    this.started_at = earlier.started_at ?? null;
    this.since = null;  // performance.now() of the moment since when the page is in front and focused
    this.listening = new AbortController();
  }

  /// From the moment the pictures are in view.
  start() {
    this.started_at ??= new Date().toISOString();
    const { signal } = this.listening;
    addEventListener("focus", () => this.follow(), { signal });
    addEventListener("blur", () => {
      this.counts.blurs += 1;
      this.follow();
    }, { signal });
    document.addEventListener("visibilitychange", () => this.follow(), { signal });
    this.follow();
  }

  stop() {
    this.settle();
    this.since = null;
    this.listening.abort();
  }

  settle() {
    if (this.since === null) return;
    const now = performance.now();
    this.counts.active_ms += now - this.since;
    this.since = now;
  }

  follow() {
    this.settle();
    this.since = document.visibilityState === "visible" && document.hasFocus() ? performance.now() : null;
  }

  count(what) {
    this.counts[what] += 1;
  }

  see(view) {
    this.views.add(view);
  }

  draft() {
    this.settle();
    return { ...this.counts, started_at: this.started_at, views: [...this.views] };
  }

  /// The fields of an answer. Window and screen in CSS pixels, times in ms.
  answer() {
    const { views, ...counts } = this.draft();
    const total_ms = Math.max(0, Date.now() - Date.parse(counts.started_at));
    return {
      ...counts,
      frames_seen: views.length,
      // Two clocks: the steady one may run a little ahead of the calendar's.
      active_ms: Math.min(total_ms, Math.round(counts.active_ms)),
      total_ms,
      window: { width: innerWidth, height: innerHeight },
      screen: { width: screen.width, height: screen.height },
      device_pixel_ratio: devicePixelRatio,
      answered_at: new Date().toISOString(),
    };
  }
}
