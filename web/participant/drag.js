// Dragging with pointer events: at once with mouse and pen, after a short hold with a finger, so
// that a page of pictures still scrolls.

const threshold_px = 6;
const hold_ms = 280;
const edge_px = 70;
const scroll_px = 14;

/// A copy of the picture follows the pointer; the picture itself stays in its list until it is
/// dropped, so that nothing scrolls or reflows under the hand.
class Drag {
  constructor(item, picture, handlers, { clientX, clientY }) {
    Object.assign(this, { item, handlers });
    this.from = [clientX, clientY];
    this.at = this.from;
    this.target = null;
    const { left, top, width } = picture.getBoundingClientRect();
    this.ghost = picture.cloneNode();
    this.ghost.alt = "";
    this.ghost.className = "ghost";
    Object.assign(this.ghost.style, { left: `${left}px`, top: `${top}px`, width: `${width}px` });
    document.body.append(this.ghost);
    item.classList.add("dragged");
    document.documentElement.classList.add("dragging");
    this.escaping = new AbortController();
    addEventListener("keydown", (key) => key.key === "Escape" && handlers.on_escape(),
      { signal: this.escaping.signal });
    handlers.on_start();
    this.scrolling = requestAnimationFrame(() => this.scroll());
  }

  move(x, y) {
    this.at = [x, y];
    this.ghost.style.transform = `translate(${x - this.from[0]}px, ${y - this.from[1]}px)`;
    const target = this.handlers.target_at(x, y);
    if (target === this.target) return;
    this.target?.classList.remove("over");
    target?.classList.add("over");
    this.target = target;
  }

  scroll() {
    const [x, y] = this.at;
    const part = this.handlers.scrolled();
    const scrolls = part.scrollHeight > part.clientHeight && getComputedStyle(part).overflowY === "auto";
    const { top, bottom } = scrolls ? part.getBoundingClientRect() : { top: 0, bottom: innerHeight };
    // Beyond the part the hand is on its way: back to the tray, or over the edge of the window.
    const inside = !scrolls || (y > top && y < bottom);
    const step = !inside ? 0 : y < top + edge_px ? -scroll_px : y > bottom - edge_px ? scroll_px : 0;
    if (step !== 0) {
      (scrolls ? part : window).scrollBy({ top: step, behavior: "instant" });
      this.move(x, y);
    }
    this.scrolling = requestAnimationFrame(() => this.scroll());
  }

  end(drop) {
    cancelAnimationFrame(this.scrolling);
    this.escaping.abort();
    this.target?.classList.remove("over");
    this.item.classList.remove("dragged");
    document.documentElement.classList.remove("dragging");
    const rectangle = this.ghost.getBoundingClientRect();
    this.ghost.remove();
    if (drop && this.target) this.handlers.on_drop(this.target, rectangle);
  }
}

/// Lets `item` be dragged by `handle`. Handlers: target_at(x, y) -> element or null, scrolled() -> the
/// element that scrolls when the hand comes near its edge (the window where it does not), on_start(),
/// on_drop(target, rectangle of the picture at that moment).
export function make_draggable(item, handle, handlers) {
  let pressed = null;  // {pointer, x, y, hold}
  let drag = null;

  const finish = (drop) => {
    clearTimeout(pressed?.hold);
    pressed = null;
    if (!drag) return;
    drag.end(drop);
    drag = null;
    // The click that ends a drag means nothing.
    const swallow = (event) => {
      event.stopPropagation();
      event.preventDefault();
    };
    handle.addEventListener("click", swallow, { capture: true, once: true });
    setTimeout(() => handle.removeEventListener("click", swallow, { capture: true }), 50);
  };
  const begin = (event) => {
    clearTimeout(pressed.hold);
    handle.setPointerCapture(pressed.pointer);
    drag = new Drag(item, handle.querySelector("img"), { ...handlers, on_escape: () => finish(false) }, event);
  };

  handle.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !event.isPrimary) return;
    pressed = { pointer: event.pointerId, x: event.clientX, y: event.clientY, hold: 0 };
    if (event.pointerType === "touch") pressed.hold = setTimeout(() => pressed && begin(event), hold_ms);
  });
  handle.addEventListener("pointermove", (event) => {
    if (event.pointerId !== pressed?.pointer) return;
    const moved = Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y);
    if (!drag && moved > threshold_px) {
      if (event.pointerType === "touch") finish(false);
      else begin(event);
    }
    drag?.move(event.clientX, event.clientY);
  });
  handle.addEventListener("pointerup", () => finish(true));
  handle.addEventListener("pointercancel", () => finish(false));
  handle.addEventListener("lostpointercapture", () => finish(false));
  handle.addEventListener("touchmove", (event) => drag && event.preventDefault(), { passive: false });
  handle.addEventListener("contextmenu", (event) => (drag || pressed?.hold) && event.preventDefault());
}
