// SPDX-License-Identifier: Apache-2.0
// One key a character, one a tool; the arrow keys move a cursor that draws as a pointer does.

import { $, on } from '../base/dom.js';
import { isCharacter } from './characters.js';
import { rectOf } from './shapes.js';
import { TOOLS } from './tools.js';

const MOVES = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const TYPED = 'input:not([type=checkbox]), select, textarea';
const TOOL_OF = Object.fromEntries(Object.entries(TOOLS).map(([name, [key]]) => [key, name]));

/** Keys of buttons, by the buttons' ids. */
export const KEYS = { i: 'mirror-y', j: 'mirror-x', t: 'turn', n: 'repeat', 0: 'fit', '+': 'zoom-in', '[': 'zoom-out', '?': 'help' };
const WITH_CTRL = { z: 'undo', y: 'redo', c: 'copy', x: 'cut', v: 'paste', s: 'save', o: 'open' };

export class Keyboard {
  constructor(editor) {
    this.editor = editor;
    on(window, 'keydown', (event) => this.take(event));
    // What was clicked keeps no keys to itself: the next one is meant for the drawing.
    on(document, 'click', ({ detail, target }) => {
      if (detail && target.closest('button') && !target.closest('dialog')) $('overlay').focus({ preventScroll: true });
    });
  }

  take(event) {
    const { key, target } = event, isTyping = target.matches(TYPED);
    if (document.querySelector('dialog[open]') || event.altKey) return;
    if (event.ctrlKey || event.metaKey) {
      if (!isTyping || key === 's') this.command(event);
    } else if (!isTyping) this.plain(event);
    else if (key === 'Escape' || key === 'Enter') target.blur(); // what was written is taken
  }

  plain(event) {
    const { key, target } = event;
    const isPressing = (key === ' ' || key === 'Enter') && target.matches('button, summary, a');
    if (!isPressing && this.obey(key, event.shiftKey)) event.preventDefault();
  }

  command(event) {
    const key = event.key.toLowerCase(), name = key === 'z' && event.shiftKey ? 'redo' : WITH_CTRL[key];
    if (key === 'a') this.editor.selectAll();
    else if (name) press(name);
    else return;
    event.preventDefault();
  }

  /** Whether the key means something. */
  obey(key, isShifted) {
    const { editor } = this;
    if (MOVES[key]) this.step(MOVES[key], isShifted);
    else if (key === 'Enter') this.draw();
    else if (key === 'Escape') editor.leave();
    else if (key === 'Delete' || key === 'Backspace') editor.draw(' ');
    else if (TOOL_OF[key]) editor.take(TOOL_OF[key]);
    else if (KEYS[key]) press(KEYS[key]);
    else if (isCharacter(key)) editor.type(key);
    else return false;
    return true;
  }

  step([dx, dy], isShifted) {
    const { editor } = this, from = editor.cursor ?? editor.middle();
    const to = editor.cursor ? [from[0] + dx, from[1] + dy] : from;
    if (isShifted) {
      this.anchor ??= from;
      editor.select(rectOf(this.anchor, to));
    } else {
      this.anchor = null;
      if (!editor.tool.isBusy) editor.select(null);
    }
    editor.moveCursor(to);
  }

  /** Acts as a pointer that goes down and up: at one cell, or with a shape at its two ends. */
  draw() {
    const { tool, cursor } = this.editor;
    if (!cursor) return;
    if (tool.isBusy) tool.up(cursor);
    else {
      tool.down(cursor);
      if (!tool.ghost?.rect) tool.up(cursor);
    }
    this.editor.redrawOverlay();
  }
}

function press(id) {
  const button = $(id);
  if (button && !button.disabled && !button.hidden) button.click();
}
