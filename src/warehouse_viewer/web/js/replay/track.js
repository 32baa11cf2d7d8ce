// SPDX-License-Identifier: Apache-2.0
// The track of the time line: a slider for pointer and keyboard, with marks where something was wrong.

import { make, on } from '../base/dom.js';

const STEPS = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -60, PageUp: 60 }; // [s]
const COARSE = 10; // times a step, with the shift key
const NEAR = { mouse: 12, touch: 22 }; // of a mark, which the pointer then means [px]

export class Track {
  /** `seek(time)` is called for a time that a person chose, `textOf(time)` has it as text. */
  constructor(box, { seek, textOf }) {
    Object.assign(this, { box, seek, textOf, begin: 0, end: 1, time: 0 });
    this.played = box.querySelector('.played');
    this.marks = box.querySelector('.marks');
    this.tip = box.querySelector('.at');
    on(box, 'keydown', (event) => this.onKey(event));
    on(box, 'pointerdown', (event) => this.onDown(event));
    on(box, 'pointermove', (event) => this.onMove(event));
    on(box, 'pointerup', () => { this.isHeld = false; });
    on(box, 'pointercancel', () => { this.isHeld = false; });
    on(box, 'pointerleave', () => {
      this.tip.hidden = true;
      this.light(null);
    });
  }

  setRange(begin, end) {
    Object.assign(this, { begin, end: Math.max(end, begin + 1) });
    this.box.setAttribute('aria-valuemin', Math.round(begin));
    this.box.setAttribute('aria-valuemax', Math.round(this.end));
    for (const mark of this.marks.children) mark.style.left = this.left(Number(mark.dataset.time));
    this.show(this.time);
  }

  /** Marks, [{time, kind, model, text}], those that lie on each other once. */
  setMarks(marks) {
    const taken = new Set();
    this.shownMarks = marks.filter(({ time, kind }) => {
      const place = `${Math.round(500 * this.part(time))} ${kind}`;
      return !taken.has(place) && taken.add(place);
    });
    this.marks.replaceChildren(...this.shownMarks.map(({ time, kind }) => {
      const out = make('i', { className: kind === 'ALARM' ? 'alarm' : 'trouble' });
      out.dataset.time = time;
      out.style.left = this.left(time);
      return out;
    }));
  }

  show(time) {
    this.time = time;
    this.played.style.width = this.left(time);
    this.box.setAttribute('aria-valuenow', Math.round(time));
    this.box.setAttribute('aria-valuetext', this.textOf(time));
  }

  part(time) {
    return Math.min(1, Math.max(0, (time - this.begin) / (this.end - this.begin)));
  }

  left(time) {
    return `${(100 * this.part(time)).toFixed(3)}%`;
  }

  timeAt({ clientX }) {
    const { left, width } = this.box.getBoundingClientRect();
    return this.begin + Math.min(1, Math.max(0, (clientX - left) / width)) * (this.end - this.begin);
  }

  /** The mark nearest to a pointer, if it is near. */
  markAt(time, pointerType) {
    const near = (NEAR[pointerType] ?? NEAR.mouse) * (this.end - this.begin) / this.box.clientWidth;
    const away = ({ time: at }) => Math.abs(at - time);
    const nearest = this.shownMarks?.reduce((best, mark) => (best && away(best) <= away(mark) ? best : mark), null);
    return nearest && away(nearest) < near ? nearest : null;
  }

  /** Shows which mark a click would mean; null: none. */
  light(mark) {
    const at = this.shownMarks?.indexOf(mark) ?? -1;
    [...this.marks.children].forEach((element, i) => element.classList.toggle('meant', i === at));
  }

  onKey(event) {
    const { key, shiftKey } = event;
    const step = STEPS[key] && STEPS[key] * (shiftKey ? COARSE : 1);
    const to = { Home: this.begin, End: this.end }[key] ?? (step && this.time + step);
    if (to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    this.seek(Math.min(this.end, Math.max(this.begin, to)));
  }

  onDown(event) {
    this.box.setPointerCapture(event.pointerId);
    this.isHeld = true;
    const time = this.timeAt(event), mark = this.markAt(time, event.pointerType);
    this.seek(mark ? Math.max(this.begin, mark.time - 1) : time);
  }

  onMove(event) {
    const time = this.timeAt(event), mark = this.markAt(time, event.pointerType);
    this.light(this.isHeld ? null : mark);
    if (this.isHeld) this.seek(time);
    this.tip.hidden = false;
    this.tip.style.left = this.left(time);
    this.tip.textContent = mark && !this.isHeld
      ? `${this.textOf(mark.time)} · ${[mark.kind, mark.model, mark.text].filter(Boolean).join(' · ')}` : this.textOf(time);
  }
}
