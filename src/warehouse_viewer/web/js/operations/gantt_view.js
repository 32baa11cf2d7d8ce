// SPDX-License-Identifier: Apache-2.0
// What part of the hour and of the rows a Gantt shows, and what lies where in it.

import { tr } from '../language/texts.js';

const SHORTEST = 20; // a window [s]
const STEP = 1.25; // of a zoom

export class GanttView {
  constructor() {
    Object.assign(this, { begin: 0, now: 0, from: null, length: null, left: 0, width: 1, rowHeight: 18 });
  }

  /** All that is known [s]; at least a minute, so that there is something to see. */
  get whole() {
    return Math.max(60, this.now - this.begin);
  }

  get isWhole() {
    return this.length === null;
  }

  /** The window's length, beginning and end [s]; it follows the time as long as its end is now. */
  get span() {
    return Math.min(this.length ?? this.whole, this.whole);
  }

  get start() {
    const latest = this.begin + this.whole - this.span;
    return this.from === null ? latest : Math.min(Math.max(this.begin, this.from), latest);
  }

  x(time) {
    return this.left + (time - this.start) / this.span * this.width;
  }

  time(x) {
    return this.start + (x - this.left) / this.width * this.span;
  }

  /** Shows `factor` times as much, the time at x [px] where it is. */
  zoom(factor, x = this.left + this.width) {
    const fixed = this.time(x), part = (x - this.left) / this.width;
    const length = Math.max(SHORTEST, this.span * factor);
    if (length >= this.whole) {
      this.all();
      return;
    }
    this.length = length;
    this.moveTo(fixed - part * length);
  }

  step(by, x) {
    this.zoom(STEP ** by, x);
  }

  all() {
    Object.assign(this, { from: null, length: null });
  }

  /** Begins at a time [s]; at the end it follows the time. */
  moveTo(time) {
    if (this.isWhole) return;
    const latest = this.begin + this.whole - this.span;
    this.from = time >= latest - 0.005 * this.span ? null : Math.max(this.begin, time);
  }

  /** Has [from, to] in sight. */
  reveal(from, to) {
    if (this.isWhole || (from >= this.start && to <= this.start + this.span)) return;
    this.moveTo((from + to - this.span) / 2);
  }

  /** Times of the lines of an axis [s], and their distance: round numbers before now. */
  ticks(most) {
    const step = [5, 10, 30, 60, 120, 300, 600, 900, 1800].find((s) => this.span / s <= most) ?? 3600;
    const out = [];
    const end = this.begin + this.whole;
    for (let ago = 0; end - ago >= this.start; ago += step) if (end - ago <= this.start + this.span) out.push({ time: end - ago, ago });
    return out;
  }
}

/** The names of the ways to sort, and what each sorts by: a state's share, the most first. */
export const SORTS = [
  ['name', tr`name`, -1], ['waiting', tr`share waiting`, 3], ['help', tr`share needing help`, 4], ['working', tr`share working`, 2],
  ['moving', tr`share moving`, 1], ['resting', tr`share resting`, 0],
];

const collator = new Intl.Collator('en', { numeric: true });

const byName = (a, b) => (b.row.kind === 'station') - (a.row.kind === 'station') || collator.compare(a.row.name, b.row.name);

/** Rows of one kind ('' all), as {row, share}, sorted by one of SORTS; stations come first. */
export function sorted(spans, kind, sort) {
  const state = SORTS.find(([name]) => name === sort)?.[2] ?? -1;
  const rows = spans.rows.filter((row) => row.times.length && (!kind || row.kind === kind))
    .map((row) => ({ row, share: state < 0 ? 0 : row.shares(spans)[state] }));
  return rows.sort((a, b) => b.share - a.share || byName(a, b));
}
