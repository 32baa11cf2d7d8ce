// SPDX-License-Identifier: Apache-2.0
// The wall of totes: the one that gets the pieces is lit, a complete one asks to be taken away.

import { make } from '../base/dom.js';
import { tr } from '../language/texts.js';

export class Wall {
  constructor(list) {
    Object.assign(this, { list, places: [] });
  }

  /** totes: as Bench has them; quantity: the pieces that go into the lit one. */
  show(totes, quantity) {
    if (this.places.length !== totes.length) {
      this.places = totes.map(() => new Place());
      this.list.replaceChildren(...this.places.map(({ element }) => element));
    }
    totes.forEach((tote, i) => this.places[i].show(tote, quantity));
  }
}

class Place {
  constructor() {
    this.number = make('b');
    this.text = make('strong');
    this.order = make('span');
    this.element = make('li', {}, this.number, this.text, this.order);
    this.shown = '';
  }

  show({ position, reference, left, isLit, leaves }, quantity) {
    const state = isLit ? 'lit' : leaves ? 'leaves' : reference ? 'open' : 'free';
    const text = { lit: tr`put ${quantity} in`, leaves: leaves?.text, open: left ? tr`${left} to go` : tr`complete`, free: tr`free` }[state];
    const order = leaves?.reference ?? reference;
    const shown = JSON.stringify([position, state, text, order]);
    if (shown === this.shown) return;
    this.shown = shown;
    this.element.dataset.state = state;
    this.number.textContent = position;
    this.text.textContent = text;
    this.order.textContent = order;
    if (isLit) this.element.setAttribute('aria-current', 'true');
    else this.element.removeAttribute('aria-current');
  }
}
