// SPDX-License-Identifier: Apache-2.0
// A row of the list of orders. It shows one order as long as it lives: a finger may be on its button.

import { make } from '../base/dom.js';
import { OrderState } from '../base/message_enums.js';
import { lasting } from '../base/time.js';
import { tr } from '../language/texts.js';
import { ORDER_STATES } from '../base/words.js';

export class OrderRow {
  /** `cancel(order)` and `open(order)` are called with the order that the row shows. */
  constructor(cancel, open) {
    this.name = make('button', { type: 'button', className: 'order-name', title: tr`Its history, units and urgency`, click: () => open(this.order) });
    this.cells = [0, 1, 2, 3].map(() => make('span'));
    this.button = make('button', { textContent: tr`Cancel`, click: () => cancel(this.order) });
    this.cells[0].append(this.name);
    this.element = make('div', {}, ...this.cells, make('span', {}, this.button));
    this.element.setAttribute('role', 'listitem');
  }

  /** Shows an order at a time [s], at a distance from the list's beginning [px]. */
  show(order, now, top) {
    this.order = order;
    this.element.style.top = `${top}px`;
    const late = lateness(order, now);
    const key = JSON.stringify([order, late]);
    if (key === this.key) return;
    this.key = key;
    const pieces = piecesOf(order);
    const texts = [order.reference, [ORDER_STATES[order.state], order.station].filter(Boolean).join(' '), late.text, pieces];
    this.cells.forEach((cell, i) => i && Object.assign(cell, { textContent: texts[i] }));
    this.name.textContent = order.reference || tr`order ${order.order_id}`;
    this.cells[2].className = late.isLate ? 'late' : 'dim';
    this.cells[3].title = pieces;
    this.element.className = late.isLate ? 'order is-late' : 'order';
    this.element.dataset.order = order.order_id;
    this.button.hidden = isOver(order);
    this.button.ariaLabel = tr`Cancel ${order.reference}`;
  }
}

export function isOver({ state }) {
  return state === OrderState.COMPLETED || state === OrderState.CANCELLED;
}

/** What is picked of what, as '1/2 sku-3, 0/1 sku-7'. */
export function piecesOf({ lines }) {
  return lines.map(({ sku, quantity, picked }) => `${picked}/${quantity} ${sku}`).join(', ');
}

/** {isLate, text} of an order at a time [s]. */
export function lateness({ due, completed, state }, now) {
  if (!due || state === OrderState.CANCELLED) return { isLate: false, text: '' };
  const left = due - (completed || now);
  const span = lasting(Math.abs(left));
  if (left < 0) return { isLate: true, text: tr`${span} late` };
  return { isLate: false, text: completed ? tr`in time` : tr`in ${span}` };
}
