// SPDX-License-Identifier: Apache-2.0
// The last hour of robots and stations: a row for each, coloured by what it did. Only rows in sight
// are drawn, whatever their number.

import { $, make, on, onTheme, setText } from '../base/dom.js';
import { ROOT } from '../base/root.js';
import { tr } from '../language/texts.js';
import { AXIS, outline, paint, palette } from './gantt_paint.js';
import { GanttPointer } from './gantt_pointer.js';
import { GanttView, sorted, SORTS } from './gantt_view.js';
import { GanttWhy } from './gantt_why.js';
import { Spans } from './spans.js';
import { clock, lasting } from '../base/time.js';
import { ACTIVITY, ACTIVITY_CLASS, ACTIVITY_NAMES, shownName, STATION_STATES } from '../base/words.js';

const HOUR = 3590; // [s], nearly
const PERIOD = 2000; // between two requests [ms]
const BIG = matchMedia('(pointer: coarse)');
const NAMES = [120, 84]; // the width of names on a wide and on a narrow page [px]

/** What of the hour is known, where it is not all of it. */
export function knownOf({ begin, now }) {
  if (begin < 1 || now - begin > HOUR) return '';
  return tr`its last ${lasting(now - begin)}: watched since ${clock(begin)}`;
}

export class Gantt {
  constructor() {
    Object.assign(this, { spans: new Spans(), view: new GanttView(), why: new GanttWhy(), rows: [], chosen: -1, span: null, frames: 0 });
    this.box = $('gantt');
    this.inside = this.box.firstElementChild;
    this.canvas = this.box.querySelector('canvas');
    this.context = this.canvas.getContext('2d');
    this.colours = palette();
    $('gantt-sort').replaceChildren(...SORTS.map(([value, textContent]) => make('option', { value, textContent })));
    $('gantt-keys').replaceChildren(...ACTIVITY.flatMap((word, i) => [make('i', { className: `key ${ACTIVITY_CLASS[i]}` }), ` ${word} `]));
    this.listen();
    this.pointer = new GanttPointer(this);
    this.poll();
  }

  listen() {
    for (const id of ['gantt-sort', 'gantt-show']) on($(id), 'change', () => this.resort());
    on($('gantt-in'), 'click', () => this.zoom(-3));
    on($('gantt-out'), 'click', () => this.zoom(3));
    on($('gantt-all'), 'click', () => this.showAll());
    on(this.box, 'scroll', () => this.soon());
    on(this.box, 'keydown', (event) => this.onKey(event));
    on(this.box, 'focus', () => this.chosen < 0 && this.rows.length && this.choose(0, this.lastSpanOf(0)));
    new ResizeObserver(() => this.fit()).observe(this.box);
    new IntersectionObserver(([{ isIntersecting }]) => {
      this.isInSight = isIntersecting;
      if (isIntersecting) this.poll();
    }).observe(this.box);
    onTheme(() => {
      this.colours = palette();
      this.soon();
    });
  }

  // --- data
  /** Asks for what is new, again and again while it can be seen. */
  async poll() {
    clearTimeout(this.timer);
    if (this.isAsking) return;
    this.isAsking = true;
    const answer = await fetch(`${ROOT}/api/v1/spans?${this.spans.query}`).catch(() => null); // others show that the server is away
    if (answer?.ok) this.take(await answer.arrayBuffer());
    this.isAsking = false;
    if (this.isInSight && !document.hidden) this.timer = setTimeout(() => this.poll(), PERIOD);
    else this.timer = setTimeout(() => this.isInSight && this.poll(), 3 * PERIOD);
  }

  take(buffer) {
    this.spans.take(buffer);
    Object.assign(this.view, { begin: this.spans.begin, now: this.spans.now });
    setText($('gantt-known'), knownOf(this.spans));
    this.resort();
  }

  /** Sorts once more; the chosen row stays chosen. */
  resort() {
    const row = this.rows[this.chosen]?.row;
    this.rows = sorted(this.spans, $('gantt-show').value, $('gantt-sort').value);
    this.chosen = row ? this.rows.findIndex((shown) => shown.row === row || shown.row.name === row.name) : -1;
    this.fit();
  }

  // --- drawing
  fit() {
    const { view, box } = this, width = box.clientWidth;
    view.left = NAMES[width < 600 ? 1 : 0] + (this.hasShares ? 44 : 0);
    view.width = Math.max(40, width - view.left - 8);
    view.rowHeight = BIG.matches ? 26 : 18;
    this.inside.style.height = `${AXIS + view.rowHeight * this.rows.length}px`;
    const scale = devicePixelRatio, size = [width, box.clientHeight];
    if (this.size?.[0] !== size[0] || this.size?.[1] !== size[1] || this.scale !== scale) {
      Object.assign(this, { size, scale });
      Object.assign(this.canvas, { width: size[0] * scale, height: size[1] * scale });
      Object.assign(this.canvas.style, { width: `${size[0]}px`, height: `${size[1]}px` });
    }
    this.soon();
  }

  get hasShares() {
    return $('gantt-sort').value !== 'name';
  }

  soon() {
    this.request ??= requestAnimationFrame(() => {
      this.request = null;
      this.draw();
    });
  }

  draw() {
    if (!this.size?.[0]) return;
    const { view, box: { scrollTop }, size, scale } = this;
    const first = Math.floor(scrollTop / view.rowHeight);
    const count = Math.ceil((size[1] - AXIS) / view.rowHeight) + 1;
    const y = AXIS + first * view.rowHeight - scrollTop;
    this.context.setTransform(scale, 0, 0, scale, 0, 0);
    paint(this.context, { rows: this.rows.slice(first, first + count), first, y, chosen: this.chosen, view, spans: this.spans,
      colours: this.colours, size, shares: this.hasShares });
    const span = this.chosenSpan();
    const top = AXIS + this.chosen * view.rowHeight - scrollTop;
    if (span && top >= AXIS - view.rowHeight) outline(this.context, view, span, top, this.colours.accent);
    this.frames += 1;
  }

  // --- what a person asks for
  zoom(by, x) {
    this.view.step(by, x);
    this.soon();
  }

  showAll() {
    this.view.all();
    this.soon();
  }

  /** {row, span} at [x, y] of the box [px]; null: there is none. */
  at(x, y) {
    if (y < AXIS) return null;
    const entry = this.rows[Math.floor((y - AXIS + this.box.scrollTop) / this.view.rowHeight)];
    if (!entry) return null;
    const time = this.view.time(x);
    const i = x < this.view.left ? -1 : entry.row.indexAt(time);
    const known = i >= 0 && time <= this.spans.now && entry.row.states[i] < ACTIVITY.length;
    return { row: entry.row, span: known ? entry.row.span(i, this.spans) : null };
  }

  /** A row, and a span of it, in words. */
  describe(row, span) {
    if (!span) return row.name;
    const word = row.kind === 'station' ? STATION_STATES[ACTIVITY_NAMES[span.state]] : ACTIVITY[span.state];
    return tr`${row.name}: ${word}, ${lasting(span.to - span.from)}, ${clock(span.from)} to ${clock(span.to)}`;
  }

  /** Says in an element what a row did in a span, and why once that is known. */
  async explain(row, span, element) {
    const text = this.describe(row, span);
    element.textContent = text;
    const why = await this.why.of(row, span);
    if (why && element.textContent === text) element.textContent = `${text}: ${shownName(why)}`;
  }

  chosenSpan() {
    const row = this.rows[this.chosen]?.row;
    const i = row && this.span ? row.indexAt(this.span.time) : -1;
    return i >= 0 && row.states[i] < ACTIVITY.length ? row.span(i, this.spans) : null;
  }

  lastSpanOf(number) {
    return this.rows[number].row.times.length - 1;
  }

  choose(number, i) {
    this.chosen = Math.max(0, Math.min(this.rows.length - 1, number));
    const { row } = this.rows[this.chosen];
    const at = Math.max(0, Math.min(row.times.length - 1, i));
    const span = row.span(at, this.spans);
    this.span = { time: (Math.max(span.from, row.times[at]) + span.to) / 2 };
    this.view.reveal(span.from, span.to);
    this.reveal();
    this.explain(row, this.chosenSpan(), $('gantt-told'));
    this.soon();
  }

  reveal() {
    const { box, view: { rowHeight } } = this, top = this.chosen * rowHeight;
    box.scrollTop = Math.max(Math.min(box.scrollTop, top), top + rowHeight + AXIS - box.clientHeight);
  }

  onKey(event) {
    const act = this.actOf(event.key);
    if (!act || event.ctrlKey || event.altKey || event.metaKey || !this.rows.length) return;
    event.preventDefault();
    act();
  }

  actOf(key) {
    const page = Math.max(1, Math.floor(this.box.clientHeight / this.view.rowHeight) - 2);
    const rows = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -this.rows.length, End: this.rows.length }[key];
    if (rows) return () => this.toRow(rows);
    return {
      ArrowLeft: () => this.toSpan(-1), ArrowRight: () => this.toSpan(1), Enter: () => this.openOnFloor(),
      '+': () => this.zoom(-2, this.chosenX()), '=': () => this.zoom(-2, this.chosenX()), '-': () => this.zoom(2, this.chosenX()), 0: () => this.showAll(),
    }[key];
  }

  chosenX() {
    return this.span ? this.view.x(this.span.time) : undefined;
  }

  /** The row a number of rows below, at the same time. */
  toRow(by) {
    const next = Math.max(0, Math.min(this.rows.length - 1, this.chosen + by));
    this.choose(next, this.rows[next].row.indexAt(this.span?.time ?? this.spans.now));
  }

  toSpan(by) {
    const entry = this.rows[this.chosen] ?? this.rows[0];
    this.choose(Math.max(0, this.chosen), entry.row.indexAt(this.span?.time ?? this.spans.now) + by);
  }

  openOnFloor() {
    const row = this.rows[this.chosen]?.row;
    if (row) location.href = ROOT + (row.kind === 'station' ? `/station/${row.name}` : `/#${row.name}`);
  }
}
