// SPDX-License-Identifier: Apache-2.0
// What is searched and shown as text, and read from bytes.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { reasonOf } from '../../../src/warehouse_viewer/web/js/base/request.js';
import { number, percent } from '../../../src/warehouse_viewer/web/js/language/numbers.js';
import { plural } from '../../../src/warehouse_viewer/web/js/language/texts.js';
import { clock } from '../../../src/warehouse_viewer/web/js/base/time.js';
import { shownName } from '../../../src/warehouse_viewer/web/js/base/words.js';
import { planOf } from '../../../src/warehouse_viewer/web/js/panels/build_dialog.js';
import { fanOf } from '../../../src/warehouse_viewer/web/js/scene/overlays.js';
import { decode } from '../../../src/warehouse_viewer/web/js/base/protocol.js';
import { found, rowsOf, wanted } from '../../../src/warehouse_viewer/web/js/base/search.js';
import { bordersOf } from '../../../src/warehouse_viewer/web/js/scene/stage.js';

test('a search is for what a person means', () => {
  assert.equal(wanted('Robot 3'), 'kiva3');
  assert.equal(wanted(' unit  12 '), 'unit12');
  const names = ['storage_unit12', 'item70', 'item7', 'storage_unit1'];
  assert.deepEqual(found(names, 'item7'), ['item7', 'item70']);
  assert.deepEqual(found(names, 'unit12'), ['storage_unit12']);
  assert.deepEqual(found(names, ''), []);
  assert.equal(found(Array.from({ length: 50 }, (_, i) => `item${i}`), 'item').length, 6);
});

test('robots are listed by trouble, then by number', () => {
  const world = { scene: { robots: [9, 10, 1, 2] }, activity: Uint8Array.of(0, 4, 1, 4) };
  assert.deepEqual(rowsOf(world, '', ''), [3, 1, 2, 0]);
  assert.deepEqual(rowsOf(world, '', '4'), [3, 1]);
  assert.deepEqual(rowsOf(world, 'kiva1', ''), [1, 2]);
});

test('simulated time in hours, minutes and seconds, with tenths where they are wanted', () => {
  assert.equal(clock(0), '0:00:00');
  assert.equal(clock(59.96), '0:00:59');
  assert.equal(clock(0, true), '0:00:00.0');
  assert.equal(clock(59.96, true), '0:01:00.0');
  assert.equal(clock(3725.34, true), '1:02:05.3');
  assert.equal(clock(3599.97, true), '1:00:00.0');
});

test('things have one name in all sentences', () => {
  assert.equal(shownName('storage_unit142'), 'unit 142');
  assert.equal(shownName('item7 lies on the floor, off storage_unit1'), 'item 7 lies on the floor, off unit 1');
  assert.equal(shownName('follow path 89'), 'route 89');
  assert.equal(shownName('kiva3 waits behind kiva12'), 'kiva3 waits behind kiva12');
});

test('numbers are those of the locale', () => {
  assert.equal(number(-1234.5, 1), (1234.5).toLocaleString(undefined, { minimumFractionDigits: 1 }).replace(/^/, '−'));
  assert.equal(percent(0.125, 1), `${(12.5).toLocaleString(undefined)} %`);
  assert.equal(plural(1, '{n} order', '{n} orders'), '1 order');
});

test('reasons of refusals', () => {
  assert.equal(reasonOf('no'), 'no');
  assert.equal(reasonOf([{ loc: ['body', 'x'], msg: 'is not a number' }, { loc: ['body', 'y'], msg: 'missing' }]),
    'x: is not a number; y: missing');
});

test('a preset is named alone, one of your own with its counts', () => {
  const own = { name: 'mine', robots: 1, shelves: 2, items: 3 };
  assert.deepEqual(planOf('huge', own), { name: 'huge' });
  assert.deepEqual(planOf('', own), own);
});

test('the borders of cells lie midway between grid points, and are never too many', () => {
  assert.deepEqual(bordersOf(-1.5, 1.5, 1), [-1.5, -0.5, 0.5, 1.5]);
  assert.deepEqual(bordersOf(-1, 1, 1), [-0.5, 0.5]);
  assert.ok(bordersOf(-5000, 5000, 1).length <= 601);
});

test('a scan spans triangles from the laser on its robot', () => {
  const scan = { mount: [0.4, 0, 0.2, 0], angleMin: 0, angleStep: Math.PI / 2, ranges: Float32Array.of(1, Infinity) };
  const [from, first, second] = fanOf(scan, [2, 3, 0, Math.PI / 2]).map((p) => p.map((x) => Math.round(1e6 * x) / 1e6 + 0));
  assert.deepEqual([from, first, second], [[2, 3.4, 0.2], [2, 4.4, 0.2], [-3, 3.4, 0.2]]);
});

test('an update is read as it was written', () => {
  const bytes = new ArrayBuffer(40 + 28 + 36);
  const view = new DataView(bytes);
  [1, 5].forEach((x, i) => view.setUint32(4 * i, x, true));
  view.setFloat64(8, 12.5, true);
  [3, 1, 1, 0, 0].forEach((x, i) => view.setUint32(16 + 4 * i, x, true));
  view.setUint32(40, 2, true);
  view.setFloat32(44, 1.5, true);
  view.setUint8(60, 2);
  view.setFloat32(64, 3.25, true);
  view.setUint32(68, 8, true);
  view.setInt32(100, 7, true);
  const { tick, stamp, revision, robots, units, loose } = decode(bytes);
  assert.deepEqual([tick, stamp, revision], [5, 12.5, 3]);
  assert.deepEqual([robots.count, robots.i32[0], robots.f32[1], robots.u8[20], robots.f32[6]],
    [1, 2, 1.5, 2, 3.25]);
  assert.deepEqual([units.count, units.i32[0], units.i32[8], loose.count], [1, 8, 7, 0]);
});
