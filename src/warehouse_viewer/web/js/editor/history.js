// SPDX-License-Identifier: Apache-2.0
// What was drawn before, and what was taken back.

const MOST = 200, MOST_BYTES = 64e6;

export class History {
  constructor() {
    this.past = [];
    this.future = [];
  }

  /** Keeps a drawing, which changes from now on. */
  keep(drawing) {
    this.past.push(drawing.clone());
    this.future = [];
    const most = Math.max(2, Math.min(MOST, MOST_BYTES / (drawing.cells.length + 1)));
    if (this.past.length > most) this.past.shift();
  }

  /** Drops the last drawing that was kept: the change had no effect. */
  forget() {
    return this.past.pop();
  }

  /** The drawing before the present one; undefined if there is none. */
  undo(present) {
    if (this.past.length) this.future.push(present);
    return this.future.length && this.future.at(-1) === present ? this.past.pop() : undefined;
  }

  redo(present) {
    if (this.future.length) this.past.push(present);
    return this.past.length && this.past.at(-1) === present ? this.future.pop() : undefined;
  }
}
