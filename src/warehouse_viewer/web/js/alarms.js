// SPDX-License-Identifier: Apache-2.0
// What a person should look after, from whatever part of the warehouse it comes.

import { $, make } from './dom.js';

export class Alarms {
  constructor() {
    this.texts = new Map(); // by source
  }

  /** All that a source has to say now, in place of what it said before. */
  set(source, texts) {
    this.texts.set(source, texts);
    const all = [...this.texts.values()].flat();
    if (String(all) === this.shown) return; // a screen reader reads what is drawn again
    this.shown = String(all);
    $('alarms').replaceChildren(...all.map((text) => make('li', { textContent: text })));
    $('alarms').hidden = all.length === 0;
    $('no-alarms').hidden = all.length > 0;
  }
}
