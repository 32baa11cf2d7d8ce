// SPDX-License-Identifier: Apache-2.0
// What the page computes of the work: rates, lateness, where a SKU is, colours of the heat.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { ratesOf, ticksOf } from '../../../src/warehouse_viewer/web/js/chart.js';
import { coloursOf } from '../../../src/warehouse_viewer/web/js/heat.js';
import { topOf } from '../../../src/warehouse_viewer/web/js/heat_scale.js';
import { lateness } from '../../../src/warehouse_viewer/web/js/order_row.js';
import { waitingOf } from '../../../src/warehouse_viewer/web/js/stations.js';
import { piecesByUnit, skuIn } from '../../../src/warehouse_viewer/web/js/where.js';

test('rates are of the time that an interval really had', () => {
  const told = { interval: 60, begin: 90, end: 200 };
  // 90 to 120, 120 to 180, 180 to 200.
  assert.deepEqual(ratesOf(told, [1, 3, 2]), [
    { from: 0, length: 30, rate: 120 }, { from: 30, length: 60, rate: 180 }, { from: 90, length: 20, rate: 360 }]);
  // One that has hardly begun says nothing yet.
  assert.equal(ratesOf({ ...told, end: 185 }, [1, 3, 2]).length, 2);
});

test('an axis has a few round numbers', () => {
  assert.deepEqual(ticksOf(828), [0, 200, 400, 600, 800]);
  assert.deepEqual(ticksOf(1000), [0, 200, 400, 600, 800, 1000]);
  assert.deepEqual(ticksOf(400), [0, 100, 200, 300, 400]);
  assert.deepEqual(ticksOf(1.15), [0, 0.5, 1]);
});

test('a station that a person leaves alone says so, by the minute', () => {
  assert.equal(waitingOf({ waiting: 59 }), '');
  assert.equal(waitingOf({ waiting: 1219 }), 'has waited for a person for 20 min');
});

test('an order is late past its due time, until it is complete, and for ever if it was then', () => {
  assert.deepEqual(lateness({ due: 0, completed: 0, state: 'OPEN' }, 999), { isLate: false, text: '' });
  assert.deepEqual(lateness({ due: 900, completed: 0, state: 'OPEN' }, 300), { isLate: false, text: 'in 10 min' });
  assert.deepEqual(lateness({ due: 900, completed: 0, state: 'ASSIGNED' }, 1500), { isLate: true, text: '10 min late' });
  assert.deepEqual(lateness({ due: 900, completed: 800, state: 'COMPLETED' }, 1500), { isLate: false, text: 'in time' });
  assert.deepEqual(lateness({ due: 900, completed: 960, state: 'COMPLETED' }, 1500), { isLate: true, text: '1 min late' });
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
