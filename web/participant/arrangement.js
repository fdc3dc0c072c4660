// Where each picture is: which shelf, or none yet. Knows nothing of the screen.

export class Arrangement {
  /// `slots` in the order shown; there are as many shelves as pictures. Shelf 0 is most realistic.
  constructor(slots, shelves = {}, all_same = false) {
    this.slots = slots;
    this.shelves = new Map(slots.map((slot) => [slot, shelves[slot] ?? null]));
    this.all_same = all_same;
  }

  get lowest() {
    return this.slots.length - 1;
  }

  shelf_of(slot) {
    return this.shelves.get(slot);
  }

  place(slot, shelf) {
    this.shelves.set(slot, shelf === null ? null : Math.min(this.lowest, Math.max(0, shelf)));
  }

  on(shelf) {
    return this.slots.filter((slot) => this.shelves.get(slot) === shelf);
  }

  get unplaced() {
    return this.on(null);
  }

  get complete() {
    return this.all_same || this.unplaced.length === 0;
  }

  /// Everything on one shelf says the same as the explicit answer.
  get flat() {
    return this.all_same || new Set(this.shelves.values()).size === 1;
  }

  get most_realistic() {
    return this.on(Math.min(...this.shelves.values()));
  }

  get least_realistic() {
    return this.on(Math.max(...this.shelves.values()));
  }

  /// The scale read the other way round: ties stay ties, neighbours stay neighbours.
  turn_round() {
    for (const [slot, shelf] of this.shelves) {
      if (shelf !== null) this.shelves.set(slot, this.lowest - shelf);
    }
  }

  /// What the server is told: {slot: shelf}; "all look the same" is one shelf for all.
  answer() {
    return Object.fromEntries([...this.shelves].map(([slot, shelf]) => [slot, this.all_same ? 0 : shelf]));
  }

  /// What a reload needs; unplaced pictures are absent.
  draft() {
    return Object.fromEntries([...this.shelves].filter(([, shelf]) => shelf !== null));
  }
}
