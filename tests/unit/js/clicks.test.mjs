// SPDX-License-Identifier: Apache-2.0
// Statuses from before a click do not undo what it has changed.

import assert from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { Clicks } from '../../../src/warehouse_viewer/web/js/panels/clicks.js';

let now, clicks;

beforeEach(() => {
  now = 0;
  clicks = new Clicks(() => now);
});

test('without a click every status is of now', () => {
  assert.equal(clicks.mayPrecede('held', true), false);
  assert.equal(clicks.mayPrecede('held', false), false);
});

test('after a click a status that contradicts it is from before, another matter is not', () => {
  clicks.note('held', true);
  assert.equal(clicks.mayPrecede('held', false), true);
  assert.equal(clicks.mayPrecede('paused', false), false);
});

test('once a status knows of the click, the next one is of after it', () => {
  clicks.note('held', true);
  assert.equal(clicks.mayPrecede('held', true), false);
  assert.equal(clicks.mayPrecede('held', false), false);
});

test('no status is two seconds on its way', () => {
  clicks.note('held', true);
  now = 1999;
  assert.equal(clicks.mayPrecede('held', false), true);
  now = 2000;
  assert.equal(clicks.mayPrecede('held', false), false);
});

test('the second of two clicks counts', () => {
  clicks.note('held', true);
  clicks.note('held', false);
  assert.equal(clicks.mayPrecede('held', true), true);
  assert.equal(clicks.mayPrecede('held', false), false);
});
