// SPDX-License-Identifier: Apache-2.0
// Statuses from before a click do not undo what it has changed.

import assert from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { Clicks } from '../../../src/warehouse_viewer/web/js/panels/clicks.js';

let now, clicks, later;

beforeEach(() => {
  now = 0;
  later = [];
  clicks = new Clicks('again', () => now, (act, delay) => later.push([act, delay]));
});

const answered = (value) => clicks.note('held', clicks.begin('held'), value);

test('without a click every status is of now', () => {
  assert.equal(clicks.mayPrecede('held', true), false);
  assert.equal(clicks.mayPrecede('held', false), false);
});

test('after a click a status that contradicts it is from before, another matter is not', () => {
  answered(true);
  assert.equal(clicks.mayPrecede('held', false), true);
  assert.equal(clicks.mayPrecede('paused', false), false);
});

test('once a status knows of the click, the next one is of after it', () => {
  answered(true);
  assert.equal(clicks.mayPrecede('held', true), false);
  assert.equal(clicks.mayPrecede('held', false), false);
});

test('no status is two seconds on its way', () => {
  answered(true);
  now = 1999;
  assert.equal(clicks.mayPrecede('held', false), true);
  now = 2000;
  assert.equal(clicks.mayPrecede('held', false), false);
});

test('the second of two clicks counts', () => {
  answered(true);
  answered(false);
  assert.equal(clicks.mayPrecede('held', true), true);
  assert.equal(clicks.mayPrecede('held', false), false);
});

test('while another click is sent, a status may tell of it before its answer', () => {
  answered(false);
  clicks.begin('held');
  assert.equal(clicks.mayPrecede('held', true), false);
});

test('the newest status is shown once more when it can only be of after the click', () => {
  answered(true);
  assert.deepEqual(later, [['again', 2000]]);
});

test('an answer that comes after another click is not shown', () => {
  const first = clicks.begin('held'), second = clicks.begin('held');
  assert.equal(clicks.note('held', second, false), true);
  assert.equal(clicks.note('held', first, true), false);
  assert.equal(clicks.mayPrecede('held', true), true);
});
