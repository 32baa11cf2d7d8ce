// SPDX-License-Identifier: Apache-2.0
// Mouse and fingers over a Gantt: Ctrl and wheel or a pinch zooms, dragging moves, hovering shows a row's state.

import { $, on } from '../base/dom.js';

const NOTCH = 100; // of a wheel [px]

export class GanttPointer {
  constructor(gantt) {
    Object.assign(this, { gantt, pointers: new Map(), apart: 0 });
    const { box } = gantt;
    box.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    on(box, 'pointerdown', (event) => this.down(event));
    on(box, 'pointermove', (event) => this.move(event));
    for (const type of ['pointerup', 'pointercancel', 'pointerleave']) on(box, type, (event) => this.up(event));
    on(box, 'dblclick', () => gantt.openOnFloor());
  }

  /** [x, y] within the box [px]. */
  place({ clientX, clientY }) {
    const { left, top } = this.gantt.box.getBoundingClientRect();
    return [clientX - left, clientY - top];
  }

  wheel(event) {
    const { gantt } = this, [x] = this.place(event);
    if (event.ctrlKey || event.metaKey) gantt.zoom(2 * event.deltaY / NOTCH, x);
    else if (event.shiftKey || event.deltaX) this.pan(event.deltaX || event.deltaY);
    else return;
    event.preventDefault();
  }

  pan(pixels) {
    const { view } = this.gantt;
    view.moveTo(view.start + pixels / view.width * view.span);
    this.gantt.soon();
  }

  down(event) {
    this.pointers.set(event.pointerId, this.place(event));
    this.apart = this.spread();
    this.moved = 0;
  }

  up(event) {
    if (this.pointers.size === 1 && event.type === 'pointerup' && this.moved < 5) this.press(event);
    this.pointers.delete(event.pointerId);
    this.apart = this.spread();
    if (event.type === 'pointerleave') $('gantt-tip').hidden = true;
  }

  /** Chooses what was clicked. */
  press(event) {
    const { gantt } = this, found = gantt.at(...this.place(event));
    if (!found) return;
    const number = gantt.rows.findIndex(({ row }) => row === found.row);
    gantt.choose(number, found.row.indexAt(found.span?.from ?? gantt.spans.now));
    if (event.pointerType === 'touch') this.showTip(event, found);
  }

  /** Distance of two fingers [px]; 0 without two. */
  spread() {
    const [a, b] = [...this.pointers.values()];
    return b ? Math.max(10, Math.abs(a[0] - b[0])) : 0;
  }

  move(event) {
    const before = this.pointers.get(event.pointerId), now = this.place(event);
    if (!before) {
      this.showTip(event, this.gantt.at(...now));
      return;
    }
    this.pointers.set(event.pointerId, now);
    this.moved += Math.abs(now[0] - before[0]) + Math.abs(now[1] - before[1]);
    if (this.apart) this.pinch();
    else this.pan(before[0] - now[0]);
  }

  pinch() {
    const apart = this.spread(), xs = [...this.pointers.values()].map(([x]) => x);
    this.gantt.view.zoom(this.apart / apart, (xs[0] + xs[1]) / 2);
    this.apart = apart;
    this.gantt.soon();
  }

  showTip({ clientX, clientY }, row) {
    const tip = $('gantt-tip');
    tip.hidden = !row;
    if (!row) return;
    const place = () => {
      const half = tip.offsetWidth / 2;
      tip.style.left = `${Math.max(half + 4, Math.min(innerWidth - half - 4, clientX))}px`;
      tip.style.top = `${clientY}px`;
    };
    const explained = this.gantt.explain(row.row, row.span, tip);
    place();
    explained.then(place);
  }
}
