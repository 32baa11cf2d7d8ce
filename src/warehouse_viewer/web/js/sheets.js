// SPDX-License-Identifier: Apache-2.0
// Panels where there is little room: one at a time, above the tabs. And what panels cover.

import { $, on } from './dom.js';

const NARROW = matchMedia('(max-width: 760px)'); // as in floor.css
const GAP = 8; // [px]

export class Sheets {
  /** `changed()` is called when another one is open. */
  constructor(changed) {
    this.changed = changed;
    for (const button of document.querySelectorAll('[data-sheet]')) {
      on(button, 'click', () => this.show(button.ariaExpanded === 'true' ? null : button.dataset.sheet));
    }
    on(NARROW, 'change', changed);
    new ResizeObserver(() => this.fitBar()).observe($('bar'));
  }

  /** Panels begin below the bar, however many rows it has. */
  fitBar() {
    const below = `${Math.ceil($('bar').getBoundingClientRect().bottom) + GAP}px`;
    const { style } = document.documentElement;
    if (style.getPropertyValue('--below') === below) return;
    style.setProperty('--below', below);
    this.changed();
  }

  /** Opens the sheet of that id, and closes the others; null: closes all. */
  show(id) {
    for (const sheet of document.querySelectorAll('.sheet')) sheet.classList.toggle('open', sheet.id === id);
    for (const tab of document.querySelectorAll('[data-sheet]')) tab.ariaExpanded = tab.dataset.sheet === id;
    this.changed();
  }
}

/** What panels cover at the edges of the window [px]: {left, right, top, bottom}. */
export function marginsOf() {
  const top = $('bar').getBoundingClientRect().bottom + GAP;
  if (NARROW.matches) {
    const open = document.querySelector('.sheet.open:not([hidden])') ?? document.querySelector('.tabs');
    return { left: GAP, right: GAP, top, bottom: innerHeight - open.getBoundingClientRect().top + GAP };
  }
  const side = $('list-panel').getBoundingClientRect().right + GAP;
  return { left: side, right: side, top, bottom: innerHeight - $('log-panel').getBoundingClientRect().top + GAP };
}
