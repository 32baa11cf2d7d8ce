// SPDX-License-Identifier: Apache-2.0
// The brushes: a swatch, a word and a key each; and the tools.

import { $, make, on, press } from '../base/dom.js';
import { CHARACTERS, isLetter, NEXT_STATION } from './characters.js';
import { TOOLS } from './tools.js';

const SIGNS = { '>': '→', '<': '←', '^': '↑', 'v': '↓', '-': '↔', '|': '↕', 'p': 'P', 'c': 'C', 'x': '✕', 's': '▢', [NEXT_STATION]: 'A' };

export class Palette {
  constructor(editor) {
    this.editor = editor;
    this.brushes = new Map(CHARACTERS.map((character) => [character.char, this.brush(character)]));
    $('brushes').append(...this.brushes.values());
    this.tools = new Map(Object.entries(TOOLS).map(([name, tool]) => [name, this.tool(name, tool)]));
    for (const [name, button] of this.tools) {
      $(name === 'queue' || name === 'exit' ? 'lane-tools' : 'tools').append(button);
    }
    editor.on('state', () => this.show());
    this.show();
  }

  brush({ char, word, hint, look, key = char }) {
    const swatch = make('i', { className: `swatch ${look}`, textContent: SIGNS[char] ?? '' });
    swatch.style.background = `var(--cell-${look})`;
    const out = make('button', { type: 'button', title: hint, click: () => this.editor.setBrush(char) },
      swatch, make('span', { textContent: word }), make('kbd', { textContent: key }));
    out.dataset.char = char;
    return out;
  }

  tool(name, [key, word, hint]) {
    const out = make('button', { type: 'button', id: `tool-${name}`, title: `${hint} (${key})` });
    out.innerHTML = `<svg aria-hidden="true"><use href="/web/icons.svg#${name}"/></svg><span></span>`;
    out.lastChild.textContent = word;
    out.append(make('kbd', { textContent: key }));
    on(out, 'click', () => this.editor.take(name));
    return out;
  }

  show() {
    const { brush, toolName } = this.editor;
    for (const [char, button] of this.brushes) press(button, char === (isLetter(brush) ? NEXT_STATION : brush));
    for (const [name, button] of this.tools) press(button, name === toolName);
  }
}
