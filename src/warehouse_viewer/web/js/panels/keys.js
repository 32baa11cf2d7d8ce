// SPDX-License-Identifier: Apache-2.0
// Keyboard shortcuts: each presses a button, so that both always do the same.

import { $, make, on } from '../base/dom.js';
import { tr } from '../language/texts.js';

const KEYS = {
  ' ': ['pause', tr`pause or resume`, 'space'], '.': ['step', tr`one step`], z: ['undo', tr`undo 5 s`],
  h: ['home', tr`see all`], t: ['top', tr`from above`], f: ['follow', tr`follow the selected`],
  l: ['scan', tr`its laser`], p: ['path', tr`its path`], r: ['trails', tr`trails of all`],
  w: ['ways', tr`routes of the fleet`], m: ['heat', tr`heat map`], o: ['zone', tr`close a zone`], g: ['fine', tr`fine picture`], x: ['xray', tr`see through units`], q: ['left', tr`turn left`], e: ['right', tr`turn right`],
  c: ['carry', tr`carry the unit above`], v: ['drop', tr`drop it`], d: ['theme', tr`dark or light`],
  n: ['add', tr`add a robot`], a: ['add-person', tr`add a person`], b: ['build', tr`build a warehouse`], '?': ['help', tr`this help`],
};
const MORE = { '/': tr`search`, '← ↑ ↓ →': tr`in the picture: to another robot`, Enter: tr`bring it near`, '+ -': tr`larger, smaller`, '1 … 6': tr`open or close a panel`, '[ ]': tr`the next robot`, Esc: tr`select nothing` };
const TYPED = 'input[type="search"], input:not([type]), input[type="number"], select';

export class Keys {
  /** `next(step)` selects another robot, `leave()` none, `search()` goes to the field for it. */
  constructor(next, leave, search) {
    Object.assign(this, { next, leave, search });
    on(window, 'keydown', (event) => this.take(event));
    // What was clicked keeps no keys to itself: the next one is meant for the page. A
    // button reached by the tab key is still pressed with space.
    on(window, 'pointerdown', () => { this.isPointing = true; });
    on(window, 'keydown', () => { this.isPointing = false; });
    for (const type of ['click', 'change']) on(document, type, (event) => this.release(event));
    const all = [...Object.entries(KEYS).map(([key, [, meaning, name]]) => [name ?? key, meaning]),
      ...Object.entries(MORE)];
    $('keys').append(...all.flatMap(([key, meaning]) => [
      make('dt', {}, make('kbd', { textContent: key })), make('dd', { textContent: meaning })]));
    on($('help'), 'click', () => $('helper').showModal());
    on($('helper-close'), 'click', () => $('helper').close());
  }

  release({ target, type }) {
    const control = target.closest('button, select, input[type="checkbox"]');
    const isOpening = control?.matches('select') && type === 'click';
    if (control && this.isPointing && !isOpening && !control.closest('dialog')) control.blur();
  }

  take(event) {
    const { key, target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector('dialog[open]')) return;
    if (target.matches(TYPED)) {
      if (key === 'Escape') this.giveUp(target);
      return;
    }
    const isPressing = key === ' ' && target.matches('button, input'); // it presses that one
    if (!isPressing && this.obey(key, event.repeat)) event.preventDefault();
  }

  /** Leaves a field; a search that is given up finds everything again, and what it selected is left. */
  giveUp(field) {
    if (field.type === 'search') {
      field.value = '';
      field.dispatchEvent(new Event('input'));
      this.leave();
    }
    field.blur();
  }

  /** True if the key means something here; one that is held down presses a button but once. */
  obey(key, isHeld) {
    const act = { Escape: this.leave, '/': this.search,
      '[': () => this.next(-1), ']': () => this.next(1) }[key] ?? opener(key) ?? presser(key, isHeld);
    act?.();
    return Boolean(act);
  }
}

/** Panels by number, as they stand in the rail. */
function opener(key) {
  const button = document.querySelectorAll('[data-drawer]')[Number(key) - 1];
  return button && !button.hidden ? () => button.click() : null;
}

function presser(key, isHeld) {
  const button = KEYS[key] && $(KEYS[key][0]);
  // A closed drawer's buttons can be pressed, those of what is not there can not.
  const canPress = button && !button.disabled && !button.closest('[hidden]');
  return canPress ? () => isHeld || button.click() : null;
}
