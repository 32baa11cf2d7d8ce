// SPDX-License-Identifier: Apache-2.0
// The past and the future of a shift's orders as points of a chart.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { aheadOf, changesOf, doneBetween, labelOf, pastOf, policiesOf } from '../../../src/warehouse_viewer/web/js/operations/forecast.js';

const LAST = { interval: 60, begin: 90, end: 270, orders_completed: [1, 2, 3, 0] };

test('orders done are counted back from when a forecast was made', () => {
  const past = pastOf(LAST, 270);
  assert.deepEqual(past.map(({ y }) => y), [-6, -5, -3, 0, 0]);
  assert.deepEqual(past.map(({ x }) => x), [-3, -2.5, -1.5, -0.5, 0]);
  assert.deepEqual(pastOf(LAST, 210), [{ x: -2, y: -4.5 }, { x: -1.5, y: -3.5 }, { x: -0.5, y: -1.5 }, { x: 0, y: 0 }]);
  assert.deepEqual(pastOf(LAST, 80), []);
});

test('orders that were done between two forecasts are known within the last hour', () => {
  assert.equal(doneBetween(LAST, 120, 240), 5);
  assert.equal(doneBetween(LAST, 150, 300), 4);
  assert.ok(Number.isNaN(doneBetween(LAST, 60, 240)));
});

test('a forecast begins now, with no order done', () => {
  const forecast = { made_at: 600, time: [660, 720], done: { p50: [1, 3] } };
  assert.deepEqual(aheadOf(forecast, 'p50'), [{ x: 0, y: 0 }, { x: 1, y: 1 }, { x: 2, y: 3 }]);
});

test('open stations can be closed, closed ones opened, robots be more and fewer', () => {
  const changes = changesOf([{ name: 'pick1', open: true }, { name: 'pick2', open: false }]);
  assert.deepEqual(changes.map(({ text }) => text),
    ['+0 robots +2', '+0 robots +1', '+0 robots -1', '+0 robots -2', '+0 close pick1', '+0 open pick2']);
  assert.equal(changes[2].label, '1 robot fewer');
});

test('policies other than the usual can be tried, but not one that needs a file', () => {
  const about = {
    policies: { orders: ['due date', 'pile-on', 'learned'], units: ['nearest'], bins: [], batches: [], replenishment: [], storage: ['random'] },
    default_policies: { orders: 'pile-on', units: 'nearest' },
  };
  assert.deepEqual(Object.values(policiesOf(about)).flat(), [{ text: '+0 policy orders due date', label: 'orders: due date' }]);
});

test('a point of the past counts what was done since then', () => {
  const median = { label: 'half of the runs have' };
  assert.equal(labelOf(median, { x: -30 }), 'done since then');
  assert.equal(labelOf(median, { x: 30 }), 'half of the runs have');
});
