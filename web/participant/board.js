// The tray and the shelves. Picture then shelf, dragging and the keyboard all end in `move`.

import { h, icon } from "/assets/shared/dom.js";
import { make_draggable } from "./drag.js";
import { Glance } from "./glance.js";
import { turning_image } from "./orbit.js";

const glide_ms = 180;

export class Board {
  /// `on_change` is told after every move, `on_enlarge(slot)` opens the viewer, `announce(text)`
  /// speaks to screen readers.
  constructor({ arrangement, pictures, labels, strings, on_change, on_enlarge, announce }) {
    Object.assign(this, { arrangement, pictures, labels, strings, on_change, on_enlarge, announce });
    this.picked = null;
    this.glance = new Glance();
    this.gaps = new Map([...pictures.values()].map(({ slot, letter }) => [slot, h("li", { class: "gap", "aria-hidden": "true" }, letter)]));
    this.items = new Map([...pictures.values()].map((picture) => [picture.slot, this.make_picture(picture)]));
    this.shelves = arrangement.slots.map((_, shelf) => this.make_shelf(shelf));
    this.tray_list = h("ul", { class: "pictures", "aria-labelledby": "tray-heading" });
    this.tray_note = h("p", { class: "tray-note" }, icon("check"), strings.tray_empty);
    this.tray = h("section", { class: "tray", "aria-labelledby": "tray-heading", data: { shelf: "tray" } },
      h("div", { class: "tray-head" }, h("h2", { id: "tray-heading" }, strings.tray), this.tray_note), this.tray_list);
    this.reachable = this.items.get(arrangement.unplaced[0] ?? arrangement.slots[0]).querySelector(".pick");
    this.rack = h("section", { class: "rack", "aria-labelledby": "rack-heading" },
      h("h2", { id: "rack-heading", class: "unseen" }, strings.shelves),
      h("ol", { class: "shelves", role: "list" }, this.shelves));
    this.set_sizes();
    this.rack.addEventListener("focusin", ({ target }) => target.matches(".place") && this.rove(this.places, target));
    this.tray.addEventListener("click", (event) => this.clicked_on(event, null));
    this.refresh();
    this.rove(this.places, this.places[0]);
  }

  /// What the style sheet needs to know to fit everything in one window.
  set_sizes() {
    const count = this.pictures.size;
    const columns = Math.ceil(Math.sqrt(count));
    const upright = Math.max(1, columns - 1);  // in a window that is taller than wide
    const ratio = Math.max(...[...this.pictures.values()].map(({ width, height }) => width / height));
    for (const element of [this.tray, this.rack]) {
      element.style.setProperty("--ratio", ratio.toFixed(4));
      element.style.setProperty("--columns", columns);
      element.style.setProperty("--rows", Math.ceil(count / columns));
      element.style.setProperty("--columns-upright", upright);
      element.style.setProperty("--rows-upright", Math.ceil(count / upright));
    }
    const words = Object.values(this.labels).flatMap((label) => label.split(/[\s-]+/));
    this.rack.style.setProperty("--longest-word", Math.max(...words.map((word) => word.length)));
    // In a narrow window the pictures of a shelf begin below its label, however many lines it has.
    const heights = new ResizeObserver((entries) => {
      for (const { target } of entries) target.closest(".shelf").style.setProperty("--label", `${target.offsetHeight}px`);
    });
    for (const label of this.rack.querySelectorAll(".end .label")) heights.observe(label);
  }

  get places() {
    return this.shelves.map((shelf) => shelf.querySelector(".place"));
  }

  /// All pictures in the order in which the page shows them.
  get picks() {
    return [this.tray, this.rack].flatMap((part) => [...part.querySelectorAll(".pick")]);
  }

  /// The tab key reaches one of `buttons`; arrows reach the others.
  rove(buttons, reachable) {
    for (const button of buttons) button.tabIndex = button === reachable ? 0 : -1;
  }

  reach(pick) {
    this.reachable = pick;
    this.rove(this.picks, pick);
    for (const item of this.items.values()) item.querySelector(".enlarge").tabIndex = item.contains(pick) ? 0 : -1;
  }

  make_picture(picture) {
    const { strings } = this;
    const button = h("button", { type: "button", class: "pick", "aria-pressed": "false", draggable: "false" },
      turning_image(picture, { alt: picture.name, width: picture.width, height: picture.height, draggable: "false" }),
      h("span", { class: "where unseen" }));
    const item = h("li", { class: "picture", data: { slot: picture.slot } }, button,
      h("div", { class: "caption" }, h("span", { class: "letter", "aria-hidden": "true" }, picture.letter),
        h("button", { type: "button", class: "enlarge", "aria-label": strings.enlarge(picture.name),
          title: strings.enlarge(picture.name), on: { click: (event) => {
            event.stopPropagation();
            this.on_enlarge(picture.slot);
          } } }, icon("enlarge"))));
    button.addEventListener("click", (event) => {
      event.stopPropagation();
      this.pick(this.picked === picture.slot ? null : picture.slot);
    });
    button.addEventListener("dblclick", () => this.on_enlarge(picture.slot));
    button.addEventListener("keydown", (event) => this.key(event, picture.slot));
    button.addEventListener("focus", () => this.reach(button));
    this.glance.attach(button, () => strings.at(picture.name, this.shelf_text(this.arrangement.shelf_of(picture.slot))));
    make_draggable(item, button, {
      target_at: (x, y) => document.elementFromPoint(x, y)?.closest("[data-shelf]"),
      scrolled: () => this.rack,
      on_start: () => this.pick(null),
      on_drop: (target, rectangle) => this.move(picture.slot,
        target.dataset.shelf === "tray" ? null : Number(target.dataset.shelf), rectangle),
    });
    return item;
  }

  make_shelf(shelf) {
    const last = this.arrangement.lowest;
    const label = shelf === 0 ? this.labels.most : shelf === last ? this.labels.least : "";
    const place = h("button", { type: "button", class: "place" },
      h("span", { class: "label" }, label), " ", h("span", { class: "offer" }, this.strings.put_here), " ",
      h("span", { class: "unseen" }));
    const element = h("li", { class: "shelf", data: { shelf: String(shelf) } }, place, h("ul", { class: "pictures" }));
    element.classList.toggle("end", label !== "");
    element.addEventListener("click", (event) => this.clicked_on(event, shelf));
    place.addEventListener("keydown", (event) => {
      const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
      if (!step) return;
      event.preventDefault();
      this.places[Math.min(last, Math.max(0, shelf + step))].focus();
    });
    return element;
  }

  clicked_on(event, shelf) {
    if (this.picked !== null) this.move(this.picked, shelf);
    else if (event.target.closest(".place")) this.announce(this.strings.pick_first, true);
  }

  shelf_text(shelf) {
    return shelf === null ? this.strings.unplaced
      : this.strings.shelf(shelf, this.arrangement.slots.length, this.labels.most, this.labels.least);
  }

  pick(slot) {
    const before = this.picked;
    this.picked = slot;
    this.refresh();
    if (slot !== null) this.announce(this.strings.picked(this.pictures.get(slot).name));
    else if (before !== null) this.announce(this.strings.released(this.pictures.get(before).name));
  }

  key(event, slot) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const { lowest } = this.arrangement;
    const now = this.arrangement.shelf_of(slot);
    const moves = {
      // From the tray, down enters the shelves at the top and up at the bottom.
      ArrowUp: () => this.move(slot, now === null ? lowest : now - 1),
      ArrowDown: () => this.move(slot, now === null ? 0 : now + 1),
      Home: () => this.move(slot, 0),
      End: () => this.move(slot, lowest),
      m: () => this.move(slot, Math.floor(lowest / 2)),
      Delete: () => this.move(slot, null),
      Backspace: () => this.move(slot, null),
      ArrowLeft: () => this.focus_neighbour(slot, -1),
      ArrowRight: () => this.focus_neighbour(slot, 1),
      Escape: () => this.pick(null),
      e: () => this.on_enlarge(slot),
    };
    const move = moves[event.key] ?? moves[event.key.toLowerCase()];
    if (!move) return;
    event.preventDefault();
    move();
  }

  focus_neighbour(slot, step) {
    const buttons = this.picks;
    const here = buttons.indexOf(this.items.get(slot).querySelector(".pick"));
    buttons[Math.min(buttons.length - 1, Math.max(0, here + step))].focus();
  }

  /// The next picture to place after the one last reached. Says whether there is one.
  focus_next() {
    const { unplaced, slots } = this.arrangement;
    if (unplaced.length === 0) return false;
    const here = slots.findIndex((slot) => this.items.get(slot).contains(this.reachable));
    const begun = document.activeElement === this.reachable;
    this.focus(unplaced.find((slot) => slots.indexOf(slot) > here - (begun ? 0 : 1)) ?? unplaced[0]);
    return true;
  }

  /// `from` is where a dragged picture was let go, if it was dragged.
  move(slot, shelf, from = null) {
    const { name } = this.pictures.get(slot);
    const before = this.arrangement.shelf_of(slot);
    this.arrangement.place(slot, shelf);
    const now = this.arrangement.shelf_of(slot);
    this.picked = null;
    this.glide(() => this.refresh(), from ? new Map([[slot, from]]) : new Map());
    this.focus(slot);
    if (before === now) {
      if (now !== null) this.announce(this.strings.at_end(name, this.shelf_text(now)));
      return;
    }
    const others = now === null ? []
      : this.arrangement.on(now).filter((other) => other !== slot).map((other) => this.pictures.get(other).name);
    this.announce(now === null ? this.strings.taken_back(name)
      : this.strings.moved(name, this.shelf_text(now), others));
    this.on_change();
  }

  focus(slot) {
    const item = this.items.get(slot);
    item.querySelector(".pick").focus({ preventScroll: true });
    item.scrollIntoView({ block: "nearest", inline: "nearest" });
  }

  /// Lets pictures glide from where they were, or from `starts`, to where `change` puts them.
  glide(change, starts) {
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.glance.withdraw();
    const before = new Map([...this.items].map(([slot, item]) => [slot, starts.get(slot) ?? item.getBoundingClientRect()]));
    change();
    if (still) return;
    for (const [slot, item] of this.items) {
      const after = item.getBoundingClientRect();
      const [x, y] = [before.get(slot).left - after.left, before.get(slot).top - after.top];
      if (Math.abs(x) + Math.abs(y) < 1) continue;
      const scale = starts.has(slot) ? 1 : before.get(slot).height / after.height;
      item.animate([{ transformOrigin: "0 0", transform: `translate(${x}px, ${y}px) scale(${scale})` },
        { transformOrigin: "0 0", transform: "none" }],
        { duration: glide_ms, easing: "cubic-bezier(.2, .7, .2, 1)" });
    }
  }

  /// Brings the elements into the state of the arrangement.
  refresh() {
    const { arrangement, strings } = this;
    this.fill(this.tray_list, arrangement.slots.map((slot) =>
      (arrangement.shelf_of(slot) === null ? this.items : this.gaps).get(slot)));
    this.tray.classList.toggle("empty", arrangement.unplaced.length === 0);
    for (const [shelf, element] of this.shelves.entries()) {
      const here = arrangement.on(shelf);
      this.fill(element.querySelector(".pictures"), here.map((slot) => this.items.get(slot)));
      element.style.setProperty("--here", here.length);
      element.classList.toggle("filled", here.length > 0);
      const name = strings.shelf(shelf, arrangement.slots.length);
      element.querySelector(".place .unseen").textContent = this.picked === null
        ? strings.shelf_holds(name, here.map((slot) => this.pictures.get(slot).name))
        : `${this.pictures.get(this.picked).name}, ${name}`;
    }
    this.reach(this.reachable);
    this.rack.classList.toggle("picking", this.picked !== null);
    this.tray.classList.toggle("picking", this.picked !== null);
    for (const [slot, item] of this.items) {
      item.classList.toggle("picked", slot === this.picked);
      item.querySelector(".pick").setAttribute("aria-pressed", String(slot === this.picked));
      item.querySelector(".where").textContent = `, ${this.shelf_text(arrangement.shelf_of(slot))}`;
    }
  }

  fill(list, wanted) {
    // Moving an element drops its focus and restarts its picture: move only what is not there yet.
    if (wanted.every((item, index) => list.children[index] === item) && list.children.length === wanted.length) return;
    list.replaceChildren(...wanted);
  }
}
