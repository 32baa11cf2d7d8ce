// SPDX-License-Identifier: Apache-2.0
// Keeps what is drawn in the browser, so that a closed tab loses nothing.

import { on } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { drawingOf, jsonOf, textOf } from './text.js';

const SOON = 300; // after a change [ms]

export class Store {
  /** file: the one that is edited, '' for none; each has a place of its own. */
  constructor(editor, file) {
    Object.assign(this, { editor, key: `layout-editor:${file}` });
  }

  /** Keeps every change from now on. */
  follow() {
    this.editor.on('change', () => {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.keep(), SOON);
    });
    on(window, 'pagehide', () => this.keep());
    on(document, 'visibilitychange', () => this.keep());
  }

  keep() {
    clearTimeout(this.timer);
    try {
      localStorage.setItem(this.key, JSON.stringify({ time: Date.now(), drawing: jsonOf(this.editor.drawing) }));
    } catch {
      this.editor.say(tr`The browser has no room to keep this drawing: save it as a file`, 'refused');
    }
  }

  /** {time, drawing} as it was kept; null if nothing was, or it can't be read. */
  kept() {
    try {
      const kept = JSON.parse(localStorage.getItem(this.key));
      return kept && drawingOf(kept.drawing).bounds() ? kept : null;
    } catch {
      return null;
    }
  }

  static isSame(a, b) {
    return textOf(drawingOf(a)).text === textOf(drawingOf(b)).text;
  }
}
