// SPDX-License-Identifier: Apache-2.0
// Mouse, pen and fingers on the paper: one draws, two move it and zoom.

import { on } from '../base/dom.js';
import { Hand } from './tools.js';

const WHEEL = 0.0015; // of the zoom, a pixel

export class Pointer {
  constructor(editor, canvas) {
    Object.assign(this, { editor, canvas, held: new Map(), panning: null, drawing: null });
    on(canvas, 'pointerdown', (event) => this.down(event));
    on(canvas, 'pointermove', (event) => this.move(event));
    on(canvas, 'pointerup', (event) => this.up(event));
    on(canvas, 'pointercancel', (event) => this.lose(event));
    on(canvas, 'pointerleave', () => this.hover(null));
    on(canvas, 'contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
  }

  at(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  cell(event) {
    return this.editor.view.cellAt(...this.at(event));
  }

  down(event) {
    event.preventDefault();
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    this.held.set(event.pointerId, this.at(event));
    const { editor } = this;
    if (this.held.size > 1) {
      editor.tool.cancel();
      this.drawing = null;
      editor.redraw();
    } else if (event.button || editor.tool instanceof Hand) {
      this.panning = event.pointerId;
    } else {
      editor.cursor = null;
      this.drawing = event.pointerId;
      editor.tool.down(this.cell(event));
      editor.redrawOverlay();
    }
  }

  move(event) {
    const before = this.held.get(event.pointerId);
    if (before && this.held.size > 1) this.pinch(event);
    else if (before && this.panning === event.pointerId) {
      const [x, y] = this.at(event);
      this.editor.view.pan(x - before[0], y - before[1]);
      this.held.set(event.pointerId, [x, y]);
      this.editor.redraw();
    } else if (this.drawing === event.pointerId) {
      for (const moved of event.getCoalescedEvents?.() ?? []) this.lead(moved);
      this.lead(event);
    } else if (!before) this.hover(this.cell(event), event.pointerType);
  }

  lead(event) {
    const cell = this.cell(event);
    if (`${cell}` === `${this.editor.pointer}`) return;
    this.editor.tool.move(cell);
    this.editor.pointAt(cell);
  }

  hover(cell, kind = 'mouse') {
    const { editor } = this;
    if (`${cell}` === `${editor.pointer}` || editor.tool.isBusy) return;
    editor.tool.hover(kind === 'touch' ? null : cell);
    editor.pointAt(cell);
  }

  /** Two fingers: the point between them stays beneath them. */
  pinch(event) {
    const spread = () => {
      const [a, b] = [...this.held.values()];
      return { distance: Math.hypot(a[0] - b[0], a[1] - b[1]), middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2] };
    };
    const before = spread();
    this.held.set(event.pointerId, this.at(event));
    const after = spread(), { view } = this.editor;
    view.pan(after.middle[0] - before.middle[0], after.middle[1] - before.middle[1]);
    view.zoom(after.distance / Math.max(1, before.distance), ...after.middle);
    this.editor.redraw();
  }

  up(event) {
    if (!this.held.delete(event.pointerId)) return;
    if (this.drawing === event.pointerId) this.editor.tool.up(this.cell(event));
    this.end(event);
  }

  lose(event) {
    this.held.delete(event.pointerId);
    if (this.drawing === event.pointerId) this.editor.tool.cancel();
    this.end(event);
  }

  end(event) {
    if (this.drawing === event.pointerId) this.drawing = null;
    if (this.panning === event.pointerId) this.panning = null;
    this.editor.redrawOverlay();
  }

  wheel(event) {
    event.preventDefault();
    const { view } = this.editor;
    if (event.shiftKey) view.pan(-event.deltaY - event.deltaX, 0);
    else view.zoom(Math.exp(-event.deltaY * WHEEL * (event.deltaMode ? 16 : 1)), ...this.at(event));
    this.editor.redraw();
  }
}
