// What must outlive this page: values and the outbox in IndexedDB, drafts beside them. Where a browser
// refuses one (some private windows), memory keeps it and only a reload can lose an answer that has
// not left yet.

const name = "penumbra-survey";

function request_of(request) {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}

function open() {
  const opening = indexedDB.open(name, 1);
  opening.onupgradeneeded = () => {
    opening.result.createObjectStore("values");
    opening.result.createObjectStore("outbox", { keyPath: "sequence", autoIncrement: true });
  };
  return request_of(opening);
}

/// Resolves when the transaction is on disk, not when the request has been taken.
function committed(transaction) {
  return new Promise((resolve, reject) => {
    transaction.oncomplete = () => resolve();
    transaction.onerror = () => reject(transaction.error);
    transaction.onabort = () => reject(transaction.error);
  });
}

class DatabaseStorage {
  constructor(database) {
    this.database = database;
  }

  get(key) {
    return request_of(this.database.transaction("values").objectStore("values").get(key));
  }

  async set(key, value) {
    const transaction = this.database.transaction("values", "readwrite", { durability: "strict" });
    transaction.objectStore("values").put(value, key);
    await committed(transaction);
  }

  async forget(prefix) {
    const transaction = this.database.transaction("values", "readwrite");
    transaction.objectStore("values").delete(IDBKeyRange.bound(prefix, `${prefix}\uffff`));
    await committed(transaction);
  }

  /// Puts the item into the outbox and the value beside it in one transaction.
  async push(item, key, value) {
    const transaction = this.database.transaction(["values", "outbox"], "readwrite", { durability: "strict" });
    transaction.objectStore("outbox").add(item);
    transaction.objectStore("values").put(value, key);
    await committed(transaction);
  }

  items() {
    return request_of(this.database.transaction("outbox").objectStore("outbox").getAll());
  }

  async drop(sequence) {
    const transaction = this.database.transaction("outbox", "readwrite", { durability: "strict" });
    transaction.objectStore("outbox").delete(sequence);
    await committed(transaction);
  }
}

class MemoryStorage {
  constructor() {
    this.values = new Map();
    this.outbox = [];
    this.next = 1;
  }

  async get(key) {
    return this.values.get(key);
  }

  async set(key, value) {
    this.values.set(key, structuredClone(value));
  }

  async forget(prefix) {
    for (const key of [...this.values.keys()]) if (key.startsWith(prefix)) this.values.delete(key);
  }

  async push(item, key, value) {
    this.outbox.push({ ...structuredClone(item), sequence: this.next++ });
    await this.set(key, value);
  }

  async items() {
    return [...this.outbox];
  }

  async drop(sequence) {
    this.outbox = this.outbox.filter((item) => item.sequence !== sequence);
  }
}

export async function open_storage() {
  try {
    return new DatabaseStorage(await open());
  } catch {
    return new MemoryStorage();
  }
}

/// What changes with every move. localStorage writes before it returns, where a transaction that a
/// reload overtakes is rolled back; where localStorage is forbidden, drafts are kept until the next reload.
export class Drafts {
  constructor() {
    this.memory = new Map();
  }

  get(key) {
    let text = null;
    try {
      text = localStorage.getItem(key);
    } catch {
      // Forbidden: memory keeps it.
    }
    return text === null ? this.memory.get(key) : JSON.parse(text);
  }

  set(key, value) {
    this.memory.set(key, value);
    try {
      localStorage.setItem(key, JSON.stringify(value));
    } catch {
      // Forbidden or full: memory has it.
    }
  }

  forget(prefix) {
    this.memory.clear();
    try {
      for (const key of Object.keys(localStorage)) if (key.startsWith(prefix)) localStorage.removeItem(key);
    } catch {
      // Forbidden: nothing was kept there.
    }
  }
}

/// Runs `task` in one tab at a time where the browser can arrange that; elsewhere the server's
/// idempotence has to do.
export function alone(lock, task) {
  return navigator.locks ? navigator.locks.request(`${name}:${lock}`, task) : task();
}
