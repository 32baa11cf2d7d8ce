// SPDX-License-Identifier: Apache-2.0
// Where everything was at a moment: robots are drawn on their way between two updates.

import { BODY_WORDS, ROBOT_WORDS } from '../base/protocol.js';
import { wrapped } from '../base/world.js';

const FAR = 6; // [m]; a robot that moves farther between two updates was put there
const BODIES = ['units', 'loose', 'scenery'];

export class State {
  constructor() {
    this.setScene({ robots: [], units: [], items: [], scenery: [] });
  }

  setScene({ robots, units, items, scenery }) {
    this.robots = new Rows(robots.length, ROBOT_WORDS);
    this.units = new Rows(units.length, BODY_WORDS);
    this.loose = new Rows(items.length, BODY_WORDS);
    this.scenery = new Rows(scenery.length, BODY_WORDS);
    this.stamp = 0; // of the last update that was taken [s]
  }

  /** Takes an update that is due. */
  take(update) {
    this.stamp = update.stamp;
    for (const name of ['robots', ...BODIES]) this[name].take(update[name]);
  }

  /** An update with what has changed since the last one, at a time [s]; `next`: the update after it. */
  at(time, next) {
    const part = next && next.stamp > this.stamp ? (time - this.stamp) / (next.stamp - this.stamp) : 0;
    const robots = this.robots.drain(next && part > 0 ? movedBy(next.robots, Math.min(1, part)) : null);
    return { kind: 'update', stamp: time, robots,
      ...Object.fromEntries(BODIES.map((name) => [name, this[name].drain(null)])) };
  }
}

/** Rows of a table; drain() returns those that have changed. */
class Rows {
  constructor(count, words) {
    this.words = words;
    this.f32 = new Float32Array(count * words);
    this.i32 = new Int32Array(this.f32.buffer);
    this.u8 = new Uint8Array(this.f32.buffer);
    this.changed = new Set();
  }

  take({ count, words, i32 }) {
    for (let row = 0; row < count; ++row) {
      const index = i32[row * words];
      this.i32.set(i32.subarray(row * words, (row + 1) * words), index * words);
      this.changed.add(index);
    }
  }

  /** A table of the rows that have changed; `move`: {rows: Set of indices, apply(row, index)} of others. */
  drain(move) {
    const rows = [...new Set([...this.changed, ...(move?.rows ?? [])])];
    this.changed = new Set(move?.rows ?? []); // moved rows are sent again, at their final places
    const { words } = this, out = new Float32Array(rows.length * words), i32 = new Int32Array(out.buffer);
    rows.forEach((index, row) => {
      i32.set(this.i32.subarray(index * words, (index + 1) * words), row * words);
      move?.apply(out.subarray(row * words, (row + 1) * words), index);
    });
    return { count: rows.length, words, f32: out, i32, u8: new Uint8Array(out.buffer) };
  }
}

/** Puts robots on their way to where the next update has them. */
function movedBy({ count, words, f32, i32 }, part) {
  const rows = new Map(Array.from({ length: count }, (_, row) => [i32[row * words], row * words]));
  return {
    rows: new Set(rows.keys()),
    apply(row, index) {
      const to = rows.get(index);
      if (to === undefined || Math.hypot(f32[to + 1] - row[1], f32[to + 2] - row[2]) > FAR) return;
      row[1] += part * (f32[to + 1] - row[1]);
      row[2] += part * (f32[to + 2] - row[2]);
      row[3] += part * wrapped(f32[to + 3] - row[3]);
    },
  };
}
