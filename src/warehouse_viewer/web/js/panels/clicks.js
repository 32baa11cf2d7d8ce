// SPDX-License-Identifier: Apache-2.0
// What clicks have changed. A status that was on its way when a click was answered tells of before
// it, and must not undo what the page shows.

const ON_ITS_WAY = 2000; // [ms], real: how long a status may be

export class Clicks {
  /**
   * `again()` shows the newest status once more: what contradicted a click may be of after it, and a
   * status comes only when something changes. `now` returns the present time [ms], `after(act, ms)`
   * acts later.
   */
  constructor(again, now = () => performance.now(), after = setTimeout.bind(globalThis)) {
    Object.assign(this, { again, now, after });
    this.changes = new Map(); // by what changed: its value, and until when a status may not know it
    this.last = new Map(); // by what changes: its last click
  }

  /** Returns a new click on something. Statuses may tell of it before its answer. */
  begin(what) {
    const click = Symbol(what);
    this.last.set(what, click);
    this.changes.delete(what);
    return click;
  }

  /** Notes the value to which a click has changed something; false if another click came after it. */
  note(what, click, value) {
    if (this.last.get(what) !== click) return false;
    this.changes.set(what, { value, until: this.now() + ON_ITS_WAY });
    this.after(this.again, ON_ITS_WAY);
    return true;
  }

  /** Whether a status in which something has this value may be from before a click. */
  mayPrecede(what, value) {
    const change = this.changes.get(what);
    if (change && value !== change.value && this.now() < change.until) return true;
    this.changes.delete(what);
    return false;
  }
}
