// SPDX-License-Identifier: Apache-2.0
// The list of orders, of which only the rows in sight exist and were asked for.

import { get } from './api.js';
import { $, make, on, press } from './dom.js';

const BIG = matchMedia('(pointer: coarse), (max-width: 760px)'); // as in operations.css
const AROUND = 30; // rows beside those in sight that are asked for too
const PAUSE = 1000; // between two looks at which orders there are [ms]
const TYPING = 200; // after a key [ms]
const NAMES = { OPEN: 'open', ASSIGNED: 'at', COMPLETED: 'done', CANCELLED: 'cancelled' };

export class OrderList {
  /** `cancel(order_id)` is called for a row's button, `fail(error)` where the server says no. */
  constructor(cancel, fail) {
    Object.assign(this, { cancel, fail, filter: '', total: 0, first: 0, rows: [], now: 0 });
    this.box = $('orders');
    this.inside = make('div');
    this.box.append(this.inside);
    on(this.box, 'scroll', () => this.scrolled());
    on($('find'), 'submit', (event) => event.preventDefault());
    on($('search'), 'input', () => this.lookAnew(TYPING));
    for (const button of $('filters').children) {
      on(button, 'click', () => {
        this.filter = button.dataset.filter;
        for (const other of $('filters').children) press(other, other === button);
        this.lookAnew(0);
      });
    }
    new ResizeObserver(() => this.scrolled()).observe(this.box);
  }

  get rowHeight() {
    return BIG.matches ? 56 : 40;
  }

  /** The first row in sight, and how many there are. */
  get inSight() {
    const first = Math.max(0, Math.floor(this.box.scrollTop / this.rowHeight));
    return [first, Math.ceil(this.box.clientHeight / this.rowHeight) + 1];
  }

  /** Another list is wanted. */
  lookAnew(delay) {
    this.box.scrollTop = 0;
    this.soon(delay);
  }

  scrolled() {
    const [first, count] = this.inSight;
    const last = Math.min(first + count, this.total);
    if (first < this.first || last > this.first + this.rows.length) this.soon(0);
    this.draw();
  }

  /** Asks for what is in sight after so many milliseconds, and not before an answer has come. */
  soon(delay) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.look(), delay);
  }

  async look() {
    if (this.isLooking) {
      this.isStale = true;
      return;
    }
    this.isLooking = true;
    this.isStale = false;
    const [first, count] = this.inSight;
    const offset = Math.max(0, first - AROUND);
    const query = new URLSearchParams(this.filter);
    query.set('limit', count + 2 * AROUND);
    query.set('offset', offset);
    const text = $('search').value.trim();
    if (text) query.set('search', text);
    try {
      const { total, orders } = await get(`/orders?${query}`);
      Object.assign(this, { total, first: offset, rows: orders });
      this.draw();
    } catch (error) {
      this.fail(error);
    }
    this.isLooking = false;
    if (this.isStale) this.soon(0);
  }

  /** Orders have changed: those in sight show it at once; which belong into the list is asked for. */
  take({ orders, missed }) {
    const changed = new Map(orders.map((order) => [order.order_id, order]));
    this.rows = this.rows.map((row) => changed.get(row.order_id) ?? row);
    this.draw();
    if (!this.isDue && (missed || orders.length)) {
      this.isDue = true;
      setTimeout(() => {
        this.isDue = false;
        this.look();
      }, PAUSE);
    }
  }

  draw() {
    $('total').textContent = `${this.total.toLocaleString('en')} orders`;
    this.inside.style.height = `${this.rowHeight * this.total}px`;
    const [first, count] = this.inSight;
    const from = Math.max(first, this.first);
    const shown = this.rows.slice(from - this.first, first + count - this.first);
    const kept = new Map([...this.inside.children].map((row) => [row.dataset.key, row]));
    this.inside.replaceChildren(...shown.map((order, i) => {
      const key = JSON.stringify([order, lateness(order, this.now)]);
      const row = kept.get(key) ?? this.row(order, key); // a finger may be on its button
      row.style.top = `${this.rowHeight * (from + i)}px`;
      return row;
    }));
  }

  row(order, key) {
    const { order_id: id, reference, state, station, lines } = order;
    const late = lateness(order, this.now);
    const pieces = lines.map(({ sku, quantity, picked }) => `${picked}/${quantity} ${sku}`).join(', ');
    const isOver = state === 'COMPLETED' || state === 'CANCELLED';
    const out = make('div', { className: late.isLate ? 'order is-late' : 'order' },
      make('span', { textContent: reference, title: reference }),
      make('span', { textContent: [NAMES[state], station].filter(Boolean).join(' ') }),
      make('span', { textContent: late.text, className: late.isLate ? 'late' : 'dim' }),
      make('span', { textContent: pieces, title: pieces }),
      make('span', {}, ...isOver ? [] : [make('button', { textContent: 'Cancel', ariaLabel: `Cancel ${reference}`, click: () => this.cancel(id) })]));
    out.setAttribute('role', 'listitem');
    out.dataset.key = key;
    return out;
  }
}

/** {isLate, text} of an order at a time [s]. */
export function lateness({ due, completed, state }, now) {
  if (!due || state === 'CANCELLED') return { isLate: false, text: '' };
  const left = due - (completed || now);
  const minutes = `${Math.max(1, Math.round(Math.abs(left) / 60))} min`;
  if (left < 0) return { isLate: true, text: `${minutes} late` };
  return { isLate: false, text: completed ? 'in time' : `in ${minutes}` };
}
