// SPDX-License-Identifier: Apache-2.0
// What a person reported, kept on this device until the server has answered: sent in order, and again
// under the same id for as long as no answer comes. The server answers a repetition as it did first.

const RETRY = [500, 1000, 2000, 4000]; // after an attempt that no one answered [ms]; the last one again and again
const DIGITS = 16; // of a number that sorts as text

/** Thrown by `send` where the server says no, for good. */
export class Refused extends Error {}

/** A name that no other report has; randomUUID() is for secure pages alone. */
export function newId() {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  return [...bytes].map((byte) => byte.toString(16).padStart(2, '0')).join('');
}

export class Outbox {
  /** prefix: of its keys in `storage` (as localStorage). send(entry): a promise of the answer; throws
   *  Refused, or anything else where no answer came. handlers: {changed(), answered(entry, answer),
   *  refused(entry, reason)}. Entries have a key each, so that two windows of a station lose nothing. */
  constructor(prefix, storage, send, handlers, sleep = (ms, wake) => setTimeout(wake, ms)) {
    Object.assign(this, { prefix, storage, send, handlers, sleep, last: 0, failures: 0, isBusy: false, wake: null });
  }

  /** The entries that no one answered yet, in order. */
  get entries() {
    const keys = Object.keys(this.storage).filter((key) => key.startsWith(this.prefix)).sort();
    return keys.map((key) => ({ ...JSON.parse(this.storage.getItem(key)), key }));
  }

  has(sequence) {
    return this.entries.some((entry) => entry.sequence === sequence);
  }

  /** Whether the last attempt was not answered. */
  get isStuck() {
    return this.failures > 0;
  }

  /** Keeps an entry and sends it when its turn comes. Throws where this device can't keep it. */
  add(entry) {
    this.last = Math.max(this.last + 1, Date.now());
    this.storage.setItem(this.prefix + String(this.last).padStart(DIGITS, '0'), JSON.stringify(entry));
    this.handlers.changed();
    this.run();
  }

  /** Drops a report that was never on its way; returns whether there was one. */
  takeOut(sequence) {
    const entry = this.entries.find((kept) => kept.sequence === sequence && !kept.isTried);
    if (entry) this.storage.removeItem(entry.key);
    if (entry) this.handlers.changed();
    return Boolean(entry);
  }

  /** Sends at once what waits for its next attempt. */
  hurry() {
    this.wake?.();
  }

  async run() {
    if (this.isBusy) return;
    this.isBusy = true;
    for (let entry = this.entries[0]; entry; [entry] = this.entries) await this.attempt(entry);
    this.isBusy = false;
  }

  async attempt({ key, ...entry }) {
    this.storage.setItem(key, JSON.stringify({ ...entry, isTried: true }));
    try {
      this.settle(key, this.handlers.answered, entry, await this.send(entry));
    } catch (error) {
      if (error instanceof Refused) this.settle(key, this.handlers.refused, entry, error.message);
      else await this.pause();
    }
  }

  settle(key, report, entry, answer) {
    this.failures = 0;
    this.storage.removeItem(key);
    report(entry, answer);
    this.handlers.changed();
  }

  async pause() {
    this.failures += 1;
    this.handlers.changed();
    const ms = RETRY[Math.min(this.failures, RETRY.length) - 1];
    await new Promise((resolve) => {
      this.wake = resolve;
      this.sleep(ms, resolve);
    });
    this.wake = null;
  }
}
