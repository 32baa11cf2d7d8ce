// SPDX-License-Identifier: Apache-2.0
// One order: its history, station, units on their way and likely end; how urgent it is, and when it is due.

import { get, patch } from '../base/api.js';
import { $, make, on, press, setText } from '../base/dom.js';
import { ROOT } from '../base/root.js';
import { tr } from '../language/texts.js';
import { clock, lasting } from '../base/time.js';
import { ORDER_STATES } from '../base/words.js';
import { mark, whole } from './order_entry.js';
import { isOver, lateness, piecesOf } from './order_row.js';

const URGENT = 255, MOST_MINUTES = 1e6;
const KINDS = { RECEIVED: tr`received`, ASSIGNED: tr`given to`, PICKED: tr`picked`, COMPLETED: tr`complete`, CANCELLED: tr`cancelled`, SHORT: tr`short of`,
  UNPICKED: tr`put back`, REOPENED: tr`open again`, CHANGED: tr`changed to` };

export class OrderDetails {
  /** `now()`: the simulated time [s]; `done(text)` is called after a change. */
  constructor(now, done) {
    Object.assign(this, { now, done });
    on($('order-close'), 'click', () => $('order').close());
    on($('order-urgent'), 'click', () => this.change({ priority: this.order.priority === URGENT ? 0 : URGENT }));
    on($('order-form'), 'input', ({ target }) => target.ariaInvalid === 'true' && mark(target, ''));
    on($('order-form'), 'submit', (event) => {
      event.preventDefault();
      this.submit();
    });
  }

  async open(order) {
    this.say('');
    this.show(order, true);
    $('order').showModal();
    await this.readHistory();
  }

  /** Orders have changed. */
  async take({ orders }) {
    const changed = $('order').open && orders.find(({ order_id: id }) => id === this.order.order_id);
    if (!changed) return;
    this.show(changed);
    await this.readHistory();
  }

  show(order, isNew = false) {
    this.order = order;
    const { order_id: id, reference, priority, due, state } = order, over = isOver(order);
    setText($('order-title'), reference ? tr`${reference}, order ${id}` : tr`Order ${id}`);
    $('order-form').hidden = over;
    press($('order-urgent'), priority === URGENT);
    if (isNew) {
      $('order-priority').value = priority;
      $('order-due').value = due ? Math.max(0, Math.round((due - this.now()) / 60)) : '';
      this.due = $('order-due').value;
      for (const name of ['order-priority', 'order-due']) mark($(name), '');
    }
    this.facts = [[tr`state`, [ORDER_STATES[state], order.station].filter(Boolean).join(' ')],
      [tr`pieces`, piecesOf(order)], [tr`priority`, priority === URGENT ? tr`${priority}, urgent` : String(priority)],
      [tr`due`, due ? `${clock(due)}, ${lateness(order, this.now()).text}` : tr`at any time`]];
    this.showFacts();
  }

  showFacts(more = []) {
    $('order-facts').replaceChildren(...[...this.facts, ...more].flatMap(([what, ...value]) => [
      make('dt', { textContent: what }), make('dd', {}, ...value)]));
  }

  async readHistory() {
    const { order_id: id } = this.order;
    try {
      const { events, storage_units: units, estimated } = await get(`/orders/${id}/history`);
      if (id !== this.order.order_id) return;
      const links = units.flatMap((name) => [make('a', { href: `${ROOT}/#${name}`, textContent: name.replace('storage_', '').replace(/(\d)/, ' $1') }), ' ']);
      this.showFacts([[tr`units`, ...links.length ? links : [tr`none on its way`]],
        ...isOver(this.order) ? [] : [[tr`likely complete`, estimated ? tr`${clock(estimated)}, in ${lasting(estimated - this.now())}` : tr`not known: few orders that are done took this long`]]]);
      $('order-events').replaceChildren(...events.reverse().map((event) => make('li', {},
        make('span', { className: 'dim', textContent: clock(event.time) }), ` ${said(event)}`)));
    } catch (error) {
      this.say(error.message);
    }
  }

  submit() {
    try {
      const change = { priority: this.read('order-priority', URGENT) };
      const text = $('order-due').value.trim();
      // Minutes are rounded: what is left as it was stays as it was.
      if (text !== this.due) change.due = text ? this.now() + 60 * this.read('order-due', MOST_MINUTES) : 0;
      this.change(change);
    } catch { /* the field says it */ }
  }

  /** A whole number in a field, which is marked where it has none. */
  read(id, most) {
    try {
      return whole($(id).value, 0, most);
    } catch (error) {
      mark($(id), error.message);
      throw error;
    }
  }

  async change(change) {
    const { order_id: id, reference } = this.order;
    try {
      const { message } = await patch(`/orders/${id}`, change);
      this.say(message, 'done');
      this.show(await get(`/orders/${id}`), true);
      await this.readHistory();
      this.done(`${reference || tr`order ${id}`}: ${message}`);
    } catch (error) {
      this.say(error.message);
    }
  }

  say(text, kind = 'refused') {
    Object.assign($('order-answer'), { hidden: !text, textContent: text });
    $('order-answer').dataset.kind = kind;
  }
}

/** An event of an order as a sentence. */
function said({ kind, sku, quantity, station, storage_unit: unit, text }) {
  const pieces = sku && `${quantity ? `${quantity} × ` : ''}${sku}`;
  const from = unit && tr`from ${unit.replace('storage_unit', 'unit ')}`;
  const at = station && (kind === 'ASSIGNED' ? station : tr`at ${station}`);
  return [KINDS[kind] ?? kind, pieces, from, at, text].filter(Boolean).join(' ');
}
