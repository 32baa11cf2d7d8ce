// SPDX-License-Identifier: Apache-2.0
// What clicks have changed. A status that was on its way when a click was answered tells of before
// it, and must not undo what the page shows.

const ON_ITS_WAY = 2000; // [ms], real: how long a status may be

export class Clicks {
  /** `now` returns the present time [ms]. */
  constructor(now = () => performance.now()) {
    this.now = now;
    this.changes = new Map(); // by what changed: its value, and until when a status may not know it
  }

  /** Notes that a click has changed something to a value. */
  note(what, value) {
    this.changes.set(what, { value, until: this.now() + ON_ITS_WAY });
  }

  /** Whether a status in which something has this value may be from before a click. */
  mayPrecede(what, value) {
    const change = this.changes.get(what);
    if (change && value !== change.value && this.now() < change.until) return true;
    this.changes.delete(what);
    return false;
  }
}
