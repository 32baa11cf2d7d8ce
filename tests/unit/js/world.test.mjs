// SPDX-License-Identifier: Apache-2.0
// Where things are drawn between what the server tells.

import assert from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { World, within, wrapped } from '../../../src/warehouse_viewer/web/js/base/world.js';
import { AT, scene, table } from './scene/look.mjs';

const BODY = 9, ROBOT = 7;
const bodies = (...rows) => table(rows, BODY, [0, 8]);
const robots = (...rows) => table(rows.map((row) => [...row, 0]), ROBOT, [0, 4, 5]); // index x y yaw shelf activity|state<<8
let world;

function tell(now, { robot = [], unit = [] } = {}) {
  return world.apply({ stamp: now / 1000, robots: robots(...robot), units: bodies(...unit),
    loose: bodies(), scenery: bodies() }, now);
}

function near(actual, expected, tolerance = 1e-6) {
  assert.equal(actual.length, expected.length);
  actual.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) < tolerance,
    `${actual} is not ${expected}`));
}

beforeEach(() => {
  world = new World();
  world.setScene(scene());
  tell(1000, { robot: [[0, 1, 0, 0, 0, 0], [1, 3, 0, 0, 0, 0]], unit: [[0, ...AT(1, 2), 0], [1, ...AT(4, 0), 0]] });
});

test('a robot is first drawn where it is told', () => {
  near(world.placeOf({ kind: 'robot', index: 1 }), [3, 0, 0, 0]);
});

test('a robot is drawn on its way between two updates, and arrives', () => {
  tell(1100, { robot: [[0, 1.2, 0, 0, 0, 1]] });
  world.advance(1150);
  const [x] = world.placeOf({ kind: 'robot', index: 0 });
  assert.ok(x > 1.02 && x < 1.18, `${x}`);
  assert.deepEqual(world.advance(2000), [0]);
  near(world.placeOf({ kind: 'robot', index: 0 }), [1.2, 0, 0, 0]);
  assert.deepEqual(world.advance(2100), []);
});

test('a robot that was put elsewhere does not drive there', () => {
  tell(1100, { robot: [[0, -4, 0, 0, 0, 0]] });
  near(world.placeOf({ kind: 'robot', index: 0 }), [-4, 0, 0, 0]);
});

test('a robot turns the short way round', () => {
  tell(1100, { robot: [[0, 1, 0, 3.1, 0, 0]] });
  world.advance(5000);
  tell(5100, { robot: [[0, 1, 0, -3.1, 0, 0]] });
  world.advance(5150);
  const [, , , yaw] = world.placeOf({ kind: 'robot', index: 0 });
  assert.ok(Math.abs(yaw) > 3.1, `${yaw}`);
});

test('what is carried goes with its carrier, and its items with it', () => {
  tell(1100, { robot: [[0, 1, 0, Math.PI / 2, 3, 1]], unit: [[0, ...AT(0, 0, 0.1), 1]] });
  world.advance(5000);
  assert.equal(world.loadOf(0), 0);
  near(world.placeOf({ kind: 'unit', index: 0 }), [1, 0, 0.1, Math.PI / 2], 1e-5);
  near(world.placeOf({ kind: 'item', index: 0 }), [1, 0.2, 0.6, Math.PI / 2], 1e-5);
});

test('the unit over a robot is one that no robot carries', () => {
  tell(1100, { robot: [[1, 4, 0, 0, 0, 0]] });
  assert.equal(world.unitOver(1), 1);
  assert.equal(world.unitAt([1, 2]), 0);
  assert.equal(world.unitAt([2, 2]), -1);
  tell(1200, { unit: [[1, ...AT(), 7]] });
  assert.equal(world.unitOver(1), -1);
});

test('activity and state are read from their bytes', () => {
  tell(1100, { robot: [[1, 3, 0, 0, 0, 2 | (5 << 8)]] });
  assert.deepEqual([world.activity[1], world.state[1]], [2, 5]);
});

test('angles and frames', () => {
  near([wrapped(7)], [7 - 2 * Math.PI]);
  near(within([1, 2, 0, Math.PI / 2], [1, 0, 0.5, 0.1]), [1, 3, 0.5, Math.PI / 2 + 0.1]);
});
