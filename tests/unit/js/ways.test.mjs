// SPDX-License-Identifier: Apache-2.0
// Ways of a coordinated fleet: how they come, how they are drawn, and what the fleet's panel says.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { factsOf } from '../../../src/warehouse_viewer/web/js/panels/fleet.js';
import { decode } from '../../../src/warehouse_viewer/web/js/base/protocol.js';
import { addDashes, addSolid, Ways } from '../../../src/warehouse_viewer/web/js/layers/ways.js';
import { World } from '../../../src/warehouse_viewer/web/js/base/world.js';
import { scene } from './scene/look.mjs';

/** As viewer/protocol.py writes it: rows [id, waits for, released, planned, goal x, goal y], points. */
function message(rows, points) {
  const buffer = new ArrayBuffer(8 + 24 * rows.length + 4 * points.length);
  const [i32, f32] = [new Int32Array(buffer), new Float32Array(buffer)];
  i32.set([3, rows.length]);
  rows.forEach((row, i) => {
    i32.set(row.slice(0, 4), 2 + 6 * i);
    f32.set(row.slice(4), 6 + 6 * i);
  });
  f32.set(points, 2 + 6 * rows.length);
  return buffer;
}

test('ways are those of each robot', () => {
  const { kind, ways } = decode(message([[7, 0, 2, 1, 5, 6], [9, 7, 1, 0, NaN, NaN]], [1, 1, 2, 1, 3, 1, 4, 4]));
  assert.equal(kind, 'ways');
  assert.deepEqual([...ways.keys()], [7, 9]);
  assert.deepEqual([...ways.get(7).released], [1, 1, 2, 1]);
  assert.deepEqual([...ways.get(7).planned], [3, 1]);
  assert.deepEqual(ways.get(7).goal, [5, 6]);
  assert.deepEqual([...ways.get(9).released], [4, 4]);
  assert.deepEqual([ways.get(9).goal, ways.get(9).waitsFor], [null, 7]);
});

test('what is released is a line from the robot on, what is planned a dash a step', () => {
  const [solid, dashes] = [[], []];
  addSolid(solid, [0.25, 0], new Float32Array([0, 0, 1, 0, 1, 2]));
  assert.deepEqual(solid.filter((_, i) => i % 3 < 2), [0.25, 0, 1, 0, 1, 0, 1, 2]);
  addDashes(dashes, [1, 2], new Float32Array([2, 2, 2, 2, 2, 4]));
  assert.deepEqual(dashes.filter((_, i) => i % 3 < 2), [1.3, 2, 1.7, 2, 2, 2.6, 2, 3.4]);
});

test('who waits is tied to the one it waits for, wherever that drives', () => {
  const world = new World();
  world.setScene(scene()); // robots 1 and 7
  const ways = new Ways({ scene: { add() {} }, invalidate() {} }, world);
  world.shown.set([1, 2, 0, 3, 4, 0]);
  ways.show(decode(message([[7, 1, 1, 0, NaN, NaN], [99, 1, 1, 0, NaN, NaN]], [3, 4, 8, 8])).ways, null);
  const drawn = () => Array.from(ways.ties.numbers).filter((_, i) => i % 3 < 2);
  assert.deepEqual(drawn(), [3, 4, 1, 2]);
  world.shown.set([1, 5], 0);
  ways.follow();
  assert.deepEqual(drawn(), [3, 4, 1, 5]);
  ways.show(ways.ways, [1]);
  assert.deepEqual(drawn(), []);
});

test('the panel counts what is there', () => {
  const facts = Object.fromEntries(factsOf({
    robots: { automatic: 18, manual: 2, out_of_service: 0 }, work: { idle: 0, fetching: 3 },
    transports: { open: 1, under_way: 17, delivered: 40, stored: 35, failed: 2 },
    plan_p50: 1.04, plan_p99: 3.5, executed_over_planned: 1.083, collisions: 0, blocked: 0, watchdog: 0,
  }));
  assert.equal(facts.robots, '18 automatic, 2 manual');
  assert.equal(facts['at work'], '3 fetching');
  assert.equal(facts.completed, '40 delivered, 35 stored, 2 failed');
  assert.equal(facts['planning time'], 'median 1.0 ms, p99 3.5 ms');
  assert.equal(facts.incidents, 'nothing');
});
