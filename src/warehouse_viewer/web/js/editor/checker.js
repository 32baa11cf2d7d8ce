// SPDX-License-Identifier: Apache-2.0
// Has the server check the drawing soon after each change, also amid a stroke, and lists what is wrong with it.

import { $, make } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { ask } from './server.js';
import { textOf } from './text.js';

const SOON = 150; // after the last change [ms]
const MOST = 100; // faults in the list

export class Checker {
  constructor(editor) {
    Object.assign(this, { editor, isAsking: false, isStale: false, took: 0 });
    for (const what of ['change', 'draft']) editor.on(what, () => this.later());
  }

  later() {
    this.isStale = true;
    $('faults-state').textContent = tr`checking …`;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.check(), SOON);
  }

  /** One question at a time; what changes meanwhile is asked after it. */
  async check() {
    if (this.isAsking || !this.isStale) return;
    Object.assign(this, { isAsking: true, isStale: false });
    const began = performance.now();
    try {
      await this.take(this.editor.drawing);
      this.took = performance.now() - began;
    } catch (error) {
      $('faults-state').textContent = tr`not checked: ${error.message}`;
    }
    this.isAsking = false;
    if (this.isStale) this.check();
  }

  async take(drawing) {
    if (!drawing.bounds()) {
      this.show([], [], {});
      return;
    }
    const { text, origin: [left, bottom] } = textOf(drawing);
    const { faults, remarks, lanes } = await ask('POST', '/check', { text });
    const moved = (cells) => cells.map(([column, row]) => [column + left, row + bottom]);
    this.show(faults.map((f) => ({ text: f.text, cells: moved(f.cells) })), remarks,
      Object.fromEntries(Object.entries(lanes).map(([key, cells]) => [key, moved(cells)])));
  }

  show(faults, remarks, lanesFound) {
    Object.assign(this.editor, { faults, lanesFound });
    $('faults-state').textContent = !this.editor.bounds ? tr`nothing drawn yet` : faults.length ? '' : remarks.join('; ') || tr`none`;
    $('faults-count').textContent = faults.length || '';
    $('faults').replaceChildren(...faults.slice(0, MOST).map((fault) => (
      make('li', {}, make('button', { type: 'button', textContent: fault.text, click: () => this.editor.showCells(fault.cells) })))));
    this.editor.redrawOverlay();
  }
}
