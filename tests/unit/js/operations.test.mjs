// SPDX-License-Identifier: Apache-2.0
// What the page computes of the work: rates, lateness, where a SKU is, colours of the heat, new orders;
// what is told of alarms, and where the focus stays.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { AlarmVoice } from '../../../src/warehouse_viewer/web/js/base/alarm_voice.js';
import { arrange, keepRows, whileBusy } from '../../../src/warehouse_viewer/web/js/base/dom.js';
import { verdict } from '../../../src/warehouse_viewer/web/js/operations/figures.js';
import { coloursOf } from '../../../src/warehouse_viewer/web/js/layers/heat.js';
import { topOf } from '../../../src/warehouse_viewer/web/js/base/heat_scale.js';
import { whole } from '../../../src/warehouse_viewer/web/js/operations/order_entry.js';
import { lateness } from '../../../src/warehouse_viewer/web/js/operations/order_row.js';
import { sizeOf } from '../../../src/warehouse_viewer/web/js/operations/order_upload.js';
import { sharesOf } from '../../../src/warehouse_viewer/web/js/operations/robot_shares.js';
import { Choice, waitsOf } from '../../../src/warehouse_viewer/web/js/base/station.js';
import { pointsOf, ratesOf, smoothed } from '../../../src/warehouse_viewer/web/js/operations/throughput.js';
import { before, clock, lasting } from '../../../src/warehouse_viewer/web/js/base/time.js';
import { piecesByUnit, skuIn } from '../../../src/warehouse_viewer/web/js/layers/where.js';
import { countedWork } from '../../../src/warehouse_viewer/web/js/base/words.js';

globalThis.matchMedia ??= () => ({ matches: false });
const { OrderList } = await import('../../../src/warehouse_viewer/web/js/operations/order_list.js');

test('rates are of the time that an interval really had', () => {
  const told = { interval: 60, begin: 90, end: 200 };
  // 90 to 120, 120 to 180, 180 to 200.
  assert.deepEqual(ratesOf(told, [1, 3, 2]), [
    { from: 0, length: 30, rate: 120 }, { from: 30, length: 60, rate: 180 }, { from: 90, length: 20, rate: 360 }]);
  // One that has hardly begun says nothing yet.
  assert.equal(ratesOf({ ...told, end: 185 }, [1, 3, 2]).length, 2);
});

test('what was set at a station counts until the server tells of it, for five seconds', () => {
  const closed = { name: 'pick1', open: false, mode: 0 }, byHand = { ...closed, mode: 1 };
  const choice = new Choice();
  assert.deepEqual(choice.upon(closed, 0), closed);
  choice.note({ open: false, mode: 1 }, 1000);
  assert.deepEqual(choice.upon(closed, 1100), byHand); // from before
  choice.note({ open: true, mode: 1 }, 1200);
  assert.deepEqual(choice.upon(byHand, 1300), { ...byHand, open: true });
  assert.deepEqual(choice.upon({ ...byHand, open: true }, 1400), { ...byHand, open: true });
  assert.deepEqual(choice.upon(closed, 1500), closed); // another person did that
  choice.note({ open: true, mode: 1 }, 2000);
  assert.deepEqual(choice.upon(closed, 7000), closed);
});

test('points of a chart lie in the middle of their intervals, in minutes before now', () => {
  const told = { interval: 60, begin: 60, end: 180 };
  assert.deepEqual(pointsOf(told, [1, 2]), [{ x: -1.5, y: 60 }, { x: -0.5, y: 120 }]);
  assert.deepEqual(smoothed([0, 1, 2, 3, 4, 5].map((x) => ({ x, y: x }))).map(({ y }) => y), [0, 0.5, 1, 1.5, 2, 3]);
});

test('a figure is judged by its target', () => {
  assert.deepEqual(verdict({ value: 99, target: 100 })[0], 'good');
  assert.deepEqual(verdict({ value: 92, target: 100 })[0], 'near');
  assert.deepEqual(verdict({ value: 80, target: 100 })[0], 'missed');
  assert.deepEqual(verdict({ value: 5, target: 0 }), ['', '']);
  assert.deepEqual(verdict({ value: 80, target: 100, early: true }), ['', 'the shift begins']);
  assert.deepEqual(verdict({ value: 100, target: 100, early: true })[0], 'good');
  assert.deepEqual(verdict({ value: 40, target: 100, enough: true }), ['good', 'all that is ordered']);
  assert.deepEqual([0.02, 0.03, 0.05].map((value) => verdict({ value, target: 0.02 }, true)[0]), ['good', 'near', 'missed']);
});

test('spans of time are told in words', () => {
  assert.deepEqual([40, 99.6, 720, 3900].map(lasting), ['40 s', '2 min', '12 min', '1 h 5 min']);
  assert.equal(clock(3723), '1:02:03');
  assert.deepEqual([30, 225, 240].map(before), ['30 s', '3:45', '4 min']);
});

test('a row of a station tells who waits for whom', () => {
  const none = { waiting: 0, shelf_id: 0, since: 10, queue: [], activity: 'RESTING', open: true, orders: [] };
  assert.deepEqual(waitsOf(none, 50), ['', '']);
  assert.deepEqual(waitsOf({ ...none, shelf_id: 4 }, 50), ['unit 4 is there, for 40 s', '']);
  assert.deepEqual(waitsOf({ ...none, shelf_id: 4, waiting: 180 }, 50), ['unit 4 has waited for a person for 3 min', 'is-bad']);
  assert.deepEqual(waitsOf({ ...none, queue: [{ unit: 7 }], activity: 'WAITING' }, 100), ['waits for unit 7, for 90 s', 'is-long']);
  assert.deepEqual(waitsOf({ ...none, orders: [1] }, 50), ['waits for a unit, for 40 s', '']);
});

test('a typed number is whole and within its bounds, or says what was expected', () => {
  assert.equal(whole(' 12 ', 1, 255), 12);
  for (const text of ['', '1.5', '-1', '256', 'two', '1e2']) assert.throws(() => whole(text, 1, 255), /from 1 to 255 was expected/);
});

test('a table of orders is told by its size', () => {
  assert.equal(sizeOf({ orders: 1, lines: 2, pieces: 1200 }), '1 order, 2 lines, 1,200 pieces');
});

test('an order is late past its due time, until it is complete, and for ever if it was then', () => {
  assert.deepEqual(lateness({ due: 0, completed: 0, state: 'OPEN' }, 999), { isLate: false, text: '' });
  assert.deepEqual(lateness({ due: 900, completed: 0, state: 'OPEN' }, 300), { isLate: false, text: 'in 10 min' });
  assert.deepEqual(lateness({ due: 900, completed: 0, state: 'ASSIGNED' }, 1500), { isLate: true, text: '10 min late' });
  assert.deepEqual(lateness({ due: 900, completed: 800, state: 'COMPLETED' }, 1500), { isLate: false, text: 'in time' });
  assert.deepEqual(lateness({ due: 900, completed: 960, state: 'COMPLETED' }, 1500), { isLate: true, text: '60 s late' });
  assert.equal(lateness({ due: 8000, completed: 0, state: 'OPEN' }, 860).text, 'in 1 h 59 min');
  assert.equal(lateness({ due: 900, completed: 0, state: 'CANCELLED' }, 1500).isLate, false);
});

test('a question for a SKU is understood', () => {
  for (const text of ['sku-17', ' where is sku-17?', 'Where is  sku-17 ?', 'where are sku-17']) assert.equal(skuIn(text), 'sku-17');
  assert.equal(skuIn('Red Paint'), 'Red Paint');
});

const place = (item, shelf_id, sku, quantity) => [item, { item, shelf_id, sku, quantity }];

test('pieces are summed up by unit, the most first; a bin may have come to hold another SKU', () => {
  const places = new Map([place('a', 3, 's', 2), place('b', 4, 's', 5), place('c', 3, 's', 4),
    place('d', 9, 't', 7), place('e', 8, 's', 0)]);
  assert.deepEqual([...piecesByUnit(places, 's')], [[3, 6], [4, 5]]);
});

test('what is nothing is not coloured, and the most is dark red', () => {
  const values = [0, 1, 10, 10];
  assert.equal(topOf(values), 10);
  assert.equal(topOf([0, 0]), 1);
  const colours = coloursOf(values, 10);
  assert.equal(colours[3], 0);
  assert.deepEqual([...colours.subarray(12, 16)], [189, 0, 38, 230]);
  assert.ok(colours[5] > colours[9]); // yellow is greener than red
});

test('robots are counted by what they do at a glance, what needs a person first; their work in words', () => {
  const shares = sharesOf({ needs_help: 1, waiting: 4, working: 0, moving: 5, resting: 2 });
  assert.deepEqual(shares.map(({ text, look, count }) => [text, look, count]),
    [['needs help', 'needs-help', 1], ['waiting', 'waiting', 4], ['moving', 'moving', 5], ['resting', 'resting', 2]]);
  assert.deepEqual(sharesOf({}), []);
  assert.equal(countedWork({ fetching: 2, ready: 1, bringing: 0, waiting: 3, idle: 1 }), '2 fetching, 1 ready beneath a unit, 3 at a station, 1 without work');
});

/** A list without a page that is being read again while these orders come. */
function reading(news, filter = '') {
  const list = Object.create(OrderList.prototype, { text: { value: '' } });
  return Object.assign(list, { filter, box: {}, newest: 2, news: new Set(news), shift: news.length });
}

const orders = (...numbers) => numbers.map((number) => ({ order_id: number }));

test('an order that came while the list was read waits only if the list lacks it', () => {
  for (const filter of ['', 'state=OPEN']) {
    const list = reading([3, 4], filter);
    list.begun(3, orders(3, 2, 1));
    assert.equal(list.fresh, 1);
    assert.deepEqual([...list.news], [4]);
  }
});

// --- lists that change keep the focus, as far as a page without a browser can tell
/** An element: what is taken out of its list loses the focus, as in browsers. */
class Element {
  constructor() {
    Object.assign(this, { children: [], dataset: {}, disabledNow: false });
  }

  set disabled(isDisabled) {
    this.disabledNow = isDisabled;
    if (isDisabled && document.activeElement === this) document.activeElement = document.body;
  }

  contains(other) {
    return other === this || this.children.some((child) => child.contains(other));
  }

  focus() {
    document.activeElement = this;
  }

  replaceChildren(...children) {
    if (this.contains(document.activeElement)) document.activeElement = document.body;
    this.children = children;
  }
}

let list;

function begin() {
  globalThis.document = { body: new Element() };
  document.activeElement = document.body;
  list = new Element();
}

function row() {
  const out = new Element();
  out.children = [new Element()]; // its link
  return out;
}

function show(ids) {
  keepRows(list, ids.map((id) => ({ id })), { keyOf: ({ id }) => id, create: row, show: (each, { id }) => { each.text = id; } });
}

test('a row that stays is the same one, with the focus', () => {
  begin();
  show([1, 2, 3]);
  const [, second] = list.children;
  second.children[0].focus();
  show([2, 4]);
  assert.equal(list.children[0], second);
  assert.equal(document.activeElement, second.children[0]);
  assert.deepEqual(list.children.map(({ text }) => text), [2, 4]);
});

test('a list in the same order is left alone', () => {
  begin();
  show([1, 2]);
  list.replaceChildren = () => assert.fail('it was replaced');
  show([1, 2]);
});

test('where the row with the focus goes, no other gets it', () => {
  begin();
  const [gone, other] = [row(), row()];
  arrange(list, [gone, other]);
  gone.children[0].focus();
  arrange(list, [other]);
  assert.equal(document.activeElement, document.body);
});

test('a button that was pressed by a key has the focus again when its work is done', async () => {
  begin();
  const button = new Element();
  button.focus();
  await assert.rejects(whileBusy([button], async () => {
    assert.equal(document.activeElement, document.body);
    throw new Error('refused');
  }), /refused/);
  assert.equal(document.activeElement, button);
  assert.equal(button.disabledNow, false);
});

test('a person who went on meanwhile is not called back', async () => {
  begin();
  const [button, elsewhere] = [new Element(), new Element()];
  button.focus();
  await whileBusy([button], async () => elsewhere.focus());
  assert.equal(document.activeElement, elsewhere);
});

// --- alarms are told to a screen reader, and not more often than a person listens
let told, waiting, voice;

function listen() {
  [told, waiting] = [[], []];
  voice = new AlarmVoice((text) => told.push(text), (act) => waiting.push(act));
}

const alarm = (id) => ({ id, title: `T${id}`, text: `x${id}`, to_do: `Do ${id}.` });

test('an alarm is told once, with what to do', () => {
  listen();
  voice.take([alarm(1)]);
  voice.take([alarm(1)]);
  assert.deepEqual(told, ['Alarm: T1. x1. Do 1.']);
});

test('those that come while one is read are told together, the worst by name', () => {
  listen();
  voice.take([alarm(1)]);
  voice.take([alarm(3), alarm(1)]);
  voice.take([alarm(4), alarm(3), alarm(2), alarm(1)]);
  assert.equal(told.length, 1);
  waiting.shift()();
  assert.deepEqual(told[1], 'Alarm: T4. x4. Do 4. 2 more alarms.');
  waiting.shift()();
  assert.equal(told.length, 2);
});

test('what is over before it could be told is not told', () => {
  listen();
  voice.take([alarm(1)]);
  voice.take([alarm(2), alarm(1)]);
  voice.take([alarm(1)]);
  waiting.shift()();
  assert.equal(told.length, 1);
});

test('after quiet, the next is told at once', () => {
  listen();
  voice.take([alarm(1)]);
  waiting.shift()();
  voice.take([alarm(2)]);
  assert.deepEqual(told.at(-1), 'Alarm: T2. x2. Do 2.');
});

test('one that comes back is told again', () => {
  listen();
  voice.take([alarm(1)]);
  waiting.shift()();
  voice.take([]);
  voice.take([alarm(1)]);
  assert.equal(told.length, 2);
});
