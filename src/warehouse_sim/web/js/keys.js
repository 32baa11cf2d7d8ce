// SPDX-License-Identifier: Apache-2.0
// Keyboard shortcuts: each presses a button, so that both always do the same.

import { $, make } from './dom.js';

const KEYS = {
  ' ': ['pause', 'pause or go on', 'space'], '.': ['step', 'one step'], z: ['undo', 'undo 5 s'],
  h: ['home', 'see all'], t: ['top', 'from above'], f: ['follow', 'follow the selected'],
  l: ['scan', 'its laser'], p: ['path', 'its path'], r: ['trails', 'trails of all'],
  x: ['xray', 'see through units'], q: ['left', 'turn left'], e: ['right', 'turn right'],
  c: ['carry', 'carry the unit above'], v: ['drop', 'drop it'], d: ['theme', 'dark or light'],
  '?': ['help', 'this help'],
};
const MORE = { '/': 'search', '[ ]': 'the next robot', Esc: 'select nothing' };

export class Keys {
  /** `next(step)` selects another robot, `leave()` none. */
  constructor(next, leave) {
    Object.assign(this, { next, leave });
    addEventListener('keydown', (event) => this.take(event));
    const all = [...Object.entries(KEYS).map(([key, [, meaning, name]]) => [name ?? key, meaning]),
      ...Object.entries(MORE)];
    $('keys').append(...all.flatMap(([key, meaning]) => [
      make('dt', {}, make('kbd', { textContent: key })), make('dd', { textContent: meaning })]));
    $('help').onclick = () => $('helper').showModal();
    $('helper-close').onclick = () => $('helper').close();
  }

  take(event) {
    const { key, target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || $('helper').open) return;
    if (target.matches('input[type="search"], select')) {
      if (key === 'Escape') target.blur();
      return;
    }
    if (key === ' ' && target.matches('button, input')) return; // it presses that one
    const button = KEYS[key] && $(KEYS[key][0]);
    if (key === 'Escape') this.leave();
    else if (key === '/') $('search').focus();
    else if (key === '[' || key === ']') this.next(key === ']' ? 1 : -1);
    else if (button && !button.disabled && button.offsetParent) button.click();
    else return;
    event.preventDefault();
  }
}
