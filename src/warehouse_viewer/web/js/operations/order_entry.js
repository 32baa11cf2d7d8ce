// SPDX-License-Identifier: Apache-2.0
// One order, typed in: SKUs are completed from stock, and each field shows its own fault.

import { get, post } from '../base/api.js';
import { $, make, on } from '../base/dom.js';
import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';

const TYPING = 150; // after a key [ms]
const SHOWN = 20; // SKUs that a list offers
const MOST_PIECES = 2 ** 31 - 1;
const LARGE = 1e6; // limits from here on say nothing to a person who has mistyped

/** A whole number in a text, from least to most; an Error that says what was expected. */
export function whole(text, least, most) {
  const value = /^\s*\d+\s*$/.test(text) ? Number(text) : NaN;
  if (!(value >= least && value <= most)) throw new Error(tr`a whole number from ${least} ${most < LARGE || value > most ? tr`to ${number(most)}` : tr`on`} was expected`);
  return value;
}

/** The text of `input` completes to SKUs in stock. */
export function completeSkus(input) {
  let timer = 0;
  on(input, 'input', () => {
    clearTimeout(timer);
    timer = setTimeout(() => offer(input.value.trim()), TYPING);
  });
  on(input, 'focus', () => offer(input.value.trim()));
}

async function offer(text) {
  const { skus } = await find(text).catch(() => ({ skus: [] }));
  $('skus').replaceChildren(...skus.map(({ sku, available }) => make('option', { value: sku, label: tr`${available} in stock` })));
}

function find(text) {
  return get(`/skus?limit=${SHOWN}&search=${encodeURIComponent(text)}`);
}

export class OrderEntry {
  /** `now()`: the simulated time [s]; `done(text)` is called once an order is accepted. */
  constructor(now, done) {
    Object.assign(this, { now, done, lines: [] });
    on($('new-order'), 'click', () => this.open());
    on($('entry-no'), 'click', () => $('entry').close());
    on($('entry-more'), 'click', () => this.add().sku.focus());
    // A fault goes with the text that had it.
    on($('entry-form'), 'input', ({ target }) => target.ariaInvalid === 'true' && mark(target, '', $(target.getAttribute('aria-describedby'))));
    on($('entry-form'), 'submit', (event) => {
      event.preventDefault();
      this.submit();
    });
  }

  open() {
    $('entry-form').reset();
    $('entry-lines').replaceChildren();
    this.lines = [];
    this.say('');
    for (const name of ['reference', 'due', 'priority']) mark($(`entry-${name}`), '');
    this.add();
    $('entry').showModal();
    $('entry-reference').focus();
  }

  add() {
    const line = new Line(() => this.drop(line), this.lines.length + 1);
    this.lines.push(line);
    $('entry-lines').append(line.element);
    this.lines.forEach((other) => { other.remove.hidden = this.lines.length === 1; });
    return line;
  }

  drop(line) {
    this.lines = this.lines.filter((other) => other !== line);
    line.element.remove();
    this.lines.forEach((other) => { other.remove.hidden = this.lines.length === 1; });
    this.lines.at(-1).sku.focus();
  }

  /** The order as it is typed in; null where a field is wrong, which is marked then. */
  async read() {
    const entered = await Promise.all(this.lines.map((line) => line.read()));
    const due = field('entry-due', (text) => (text.trim() ? this.now() + 60 * whole(text, 1, 100000) : 0));
    const priority = field('entry-priority', (text) => whole(text, 0, 255));
    const reference = field('entry-reference', (text) => {
      if (!/^[ -~]*$/.test(text)) throw new Error(tr`letters without accents, digits and signs were expected`);
      return text.trim();
    });
    const isWrong = [...entered, due, priority, reference].includes(null);
    return isWrong ? null : { reference, lines: entered, due, priority };
  }

  async submit() {
    const order = await this.read();
    if (!order) {
      $('entry').querySelector('[aria-invalid=true]')?.focus();
      return;
    }
    try {
      const { order_id: id, message } = await post('/orders', order);
      $('entry').close();
      this.done([tr`order ${id}${order.reference ? `, ${order.reference},` : ''} is accepted`, message].filter(Boolean).join('; '));
    } catch (error) {
      this.say(error.message);
    }
  }

  say(text) {
    Object.assign($('entry-answer'), { hidden: !text, textContent: text });
    $('entry-answer').dataset.kind = 'refused';
  }
}

class Line {
  constructor(drop, place) {
    this.sku = make('input', { placeholder: tr`SKU`, ariaLabel: tr`SKU ${place}`, autocomplete: 'off', spellcheck: false });
    this.sku.setAttribute('list', 'skus');
    this.quantity = make('input', { value: '1', inputMode: 'numeric', ariaLabel: tr`Pieces of SKU ${place}`, className: 'few', autocomplete: 'off' });
    this.remove = make('button', { type: 'button', className: 'edged', textContent: '×', ariaLabel: tr`Leave out SKU ${place}`, click: drop });
    [this.skuFault, this.quantityFault] = [1, 2].map((i) => make('p', { className: 'fault', id: `entry-fault-${Line.count = (Line.count ?? 0) + 1}-${i}`, hidden: true }));
    this.sku.setAttribute('aria-describedby', this.skuFault.id);
    this.quantity.setAttribute('aria-describedby', this.quantityFault.id);
    completeSkus(this.sku);
    this.element = make('li', {}, this.sku, this.quantity, this.remove, this.skuFault, this.quantityFault);
  }

  /** {sku, quantity}; null where one is wrong. */
  async read() {
    const sku = this.sku.value.trim();
    const fault = sku ? await unknown(sku) : tr`a SKU was expected`;
    mark(this.sku, fault, this.skuFault);
    let quantity = null;
    try {
      quantity = whole(this.quantity.value, 1, MOST_PIECES);
      mark(this.quantity, '', this.quantityFault);
    } catch (error) {
      mark(this.quantity, error.message, this.quantityFault);
    }
    return fault || quantity === null ? null : { sku, quantity };
  }
}

/** Why a SKU can't be ordered; '': it can. */
async function unknown(sku) {
  const { skus } = await find(sku).catch(() => ({ skus: [{ sku }] })); // the server will refuse it
  if (skus.some((stocked) => stocked.sku === sku)) return '';
  return tr`there is no ${sku}${skus.length ? tr`; is ${skus[0].sku} meant?` : ''}`;
}

/** What `read` makes of a field's text; null where it throws, and the field says why. */
function field(id, read) {
  try {
    const value = read($(id).value);
    mark($(id), '');
    return value;
  } catch (error) {
    mark($(id), error.message);
    return null;
  }
}

/** Marks a field with what is wrong with it; '': nothing. */
export function mark(input, fault, place = $(`${input.id}-fault`)) {
  input.setAttribute('aria-invalid', String(Boolean(fault)));
  Object.assign(place, { textContent: fault, hidden: !fault });
}
