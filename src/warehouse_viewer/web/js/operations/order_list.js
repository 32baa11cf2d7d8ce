// SPDX-License-Identifier: Apache-2.0
// The list of orders: only the rows in sight exist and are fetched. Rows stand still: a
// row keeps its place until the person asks for another list, whatever comes or goes meanwhile.

import { get } from '../base/api.js';
import { $, make, on, press } from '../base/dom.js';
import { ROOT } from '../base/root.js';
import { plural, tr } from '../language/texts.js';
import { isOver, OrderRow } from './order_row.js';

const BIG = matchMedia('(pointer: coarse), (max-width: 760px)'); // as in control.css
const AROUND = 30; // rows beside those in sight that are fetched too
const TYPING = 200; // after a key [ms]

export class OrderList {
  /** `cancel(order)` and `open(order)` are called for a row's buttons, `fail(error)` where the server refuses. */
  constructor(cancel, fail, open) {
    Object.assign(this, { cancel, open, fail, filter: '', total: 0, first: 0, rows: [], now: 0 });
    this.shown = new Map(); // OrderRows by their orders' numbers
    this.forget();
    this.box = $('orders');
    this.inside = make('div');
    this.box.append(this.inside);
    on(this.box, 'scroll', () => this.scrolled());
    on($('find'), 'submit', (event) => event.preventDefault());
    on($('search'), 'input', () => this.reload(TYPING));
    on($('news'), 'click', () => this.reload(0));
    for (const button of $('filters').children) {
      on(button, 'click', () => {
        this.filter = button.dataset.filter;
        for (const other of $('filters').children) press(other, other === button);
        this.reload(0);
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

  get text() {
    return $('search').value.trim();
  }

  /** Forgets which orders came since the list was read. */
  forget() {
    this.news = new Set(); // numbers of orders that belong into the list, and are not in it yet
    this.missed = false; // whether others may
    this.shift = 0; // rows by which the server's list, where new ones come first, is ahead of this one
  }

  /** The query, without limit and offset. */
  get query() {
    const query = new URLSearchParams(this.filter);
    if (this.text) query.set('search', this.text);
    return query;
  }

  /** Reads another list, from its beginning, after a delay [ms]. */
  reload(delay) {
    this.isReload = true;
    this.soon(delay);
  }

  scrolled() {
    const [first, count] = this.inSight;
    const last = Math.min(first + count, this.total);
    if (first < this.first || last > this.first + this.rows.length) this.soon(0);
    this.draw();
  }

  /** Asks for what is in sight after a delay [ms], and not before an answer has come. */
  soon(delay) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.fetchOrders(), delay);
  }

  /** Begins, or begins again after a lost connection, during which changes were missed. */
  begin() {
    if (this.rows.length) this.take({ orders: [], missed: true });
    else this.reload(0);
  }

  /** How many orders wait to be shown. */
  get fresh() {
    return this.isWhole ? Math.max(this.news.size, this.shift) : this.news.size;
  }

  /** Whether it is the list of all orders: there an order stays for ever. */
  get isWhole() {
    return !this.filter && !this.text;
  }

  async fetchOrders() {
    if (this.isLooking) {
      this.isStale = true;
      return;
    }
    this.isLooking = true;
    this.isStale = false;
    const { isReload } = this;
    this.isReload = false;
    const [sight, count] = this.inSight;
    const offset = isReload ? 0 : Math.max(0, sight - AROUND + this.shift);
    if (isReload) this.forget();
    const { query } = this;
    for (const kind of ['csv', 'xlsx']) $(`out-${kind}`).href = `${ROOT}/api/v1/orders.${kind}?${query}`;
    query.set('limit', count + 2 * AROUND);
    query.set('offset', offset);
    try {
      const { total, orders } = await get(`/orders?${query}`);
      if (isReload) this.begun(total, orders);
      else this.went(offset, orders);
      this.draw();
    } catch (error) {
      this.fail(error);
    }
    this.isLooking = false;
    if (this.isStale) this.soon(0);
  }

  begun(total, orders) {
    this.box.scrollTop = 0;
    Object.assign(this, { total, first: 0, rows: orders });
    this.newest = Math.max(this.newest ?? 0, ...orders.map(({ order_id: id }) => id));
    // Of orders that came while the answer was on its way, it has some already.
    for (const { order_id: id } of orders) this.news.delete(id);
    this.shift = this.isWhole ? this.news.size : 0;
  }

  /** Rows from `offset` on in the server's list: a known row among them gives their place here. */
  went(offset, orders) {
    const places = new Map(this.rows.map(({ order_id: id }, i) => [id, this.first + i]));
    const common = orders.findIndex(({ order_id: id }) => places.has(id));
    if (common >= 0) this.shift = offset + common - places.get(orders[common].order_id);
    const hidden = Math.max(0, this.shift - offset); // rows that are new: above the first one here
    Object.assign(this, { first: Math.max(0, offset - this.shift), rows: orders.slice(hidden) });
    if (common >= 0 && this.isWhole) this.missed = false; // the shift counts what came
  }

  /** Orders have changed: those in sight show it where they are; others wait to be asked for. */
  take({ orders, missed }) {
    const changed = new Map(orders.map((order) => [order.order_id, order]));
    const there = new Set(this.rows.map(({ order_id: id }) => id));
    this.rows = this.rows.map((row) => changed.get(row.order_id) ?? row);
    this.missed ||= missed;
    for (const [id, order] of changed) {
      const isNew = id > this.newest || (this.filter && !there.has(id));
      if (isNew && belongs(order, this.filter, this.text, this.now)) this.news.add(id);
      else this.news.delete(id);
    }
    if (this.isWhole) this.shift = Math.max(this.shift, this.news.size);
    if (!this.total && (this.news.size || missed)) this.reload(0); // nothing that could move
    else if (missed) this.soon(0);
    this.draw();
  }

  draw() {
    $('total').textContent = plural(this.total, '{n} order', '{n} orders');
    $('news').hidden = !this.fresh && !this.missed;
    $('news').textContent = this.fresh ? tr`${this.fresh} new: show` : tr`there may be new orders: show`;
    this.inside.style.height = `${this.rowHeight * this.total}px`;
    const [first, count] = this.inSight;
    const from = Math.max(first, this.first);
    const shown = this.rows.slice(from - this.first, first + count - this.first);
    const kept = this.shown;
    this.shown = new Map(shown.map((order) => (
      [order.order_id, kept.get(order.order_id) ?? new OrderRow(this.cancel, this.open)])));
    for (const [id, { element }] of kept) if (!this.shown.has(id)) element.remove();
    shown.forEach((order, i) => {
      const row = this.shown.get(order.order_id);
      row.show(order, this.now, this.rowHeight * (from + i));
      if (!row.element.isConnected) this.inside.append(row.element);
    });
  }
}

/** Whether an order is one of those that a filter of the server's query and a text ask for. */
function belongs(order, filter, text, now) {
  const query = new URLSearchParams(filter), state = query.get('state');
  if (state && order.state !== state) return false;
  if (query.has('late') && (!order.due || isOver(order) || order.due > now)) return false;
  return !text || order.reference.includes(text) || order.lines.some(({ sku }) => sku === text);
}
