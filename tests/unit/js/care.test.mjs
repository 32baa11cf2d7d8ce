// SPDX-License-Identifier: Apache-2.0
// What is said of a station that is selected, and which cells are free for what is added.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { freeCells } from '../../../src/warehouse_viewer/web/js/layers/free_cells.js';
import { factsOfStation } from '../../../src/warehouse_viewer/web/js/panels/care.js';

const link = (name) => ({ link: name });
const NONE = { open: true, activity: 'RESTING', mode: 'AUTOMATIC', queue: [], shelf_id: 0, waiting: 0, since: 10, kind: 'PICK', orders: [] };

test('a station says why it waits, its unit, its queue and what is on its way', () => {
  assert.deepEqual(factsOfStation(null, 50, link), [['state', 'no shift is running']]);
  assert.deepEqual(factsOfStation({ ...NONE, open: false }, 50, link)[0], ['state', 'closed']);
  const why = 'waits for unit 7 on kiva3, which waits in the queue of pick1 behind kiva16, which is broken';
  const queue = [{ unit: 7, robot: 3 }, { unit: 9, robot: 0 }];
  const facts = Object.fromEntries(factsOfStation({ ...NONE, activity: 'WAITING', orders: [4, 5], queue, why }, 100, link));
  assert.equal(facts.why.map((part) => (typeof part === 'string' ? part : part.link).replace('storage_', '').replace('unit7', 'unit 7')).join(''), `${why}, for 90 s`);
  assert.deepEqual(facts.why.filter((part) => part.isInText), ['storage_unit7', 'kiva3', 'kiva16'].map((name) => ({ ...link(name), isInText: true })));
  assert.deepEqual(facts.queue, [link('kiva3')]);
  assert.deepEqual(facts['on its way'], [link('storage_unit7'), link('storage_unit9')]);
  assert.deepEqual([facts.unit, facts.orders], ['none is there', '2']);
  const there = Object.fromEntries(factsOfStation({ ...NONE, shelf_id: 7, picks: [{}, {}] }, 50, link));
  assert.deepEqual(there.unit, [link('storage_unit7'), ' 2 to pick']);
});

const boundsOf = () => ({ min: [-0.3, -1.2, 0], max: [0.3, 0.3, 1] });

test('what stands on a cell, or across two, takes it', () => {
  const places = { unit: [[0, 0, 0, 0]], robot: [[1, 0, 0, 0]], scenery: [[2, 1, 0, Math.PI / 2]] };
  const world = {
    scene: { grid: 1, floor: [-0.5, 3.5, -0.5, 1.5], units: ['storage_unit1'], robots: [1], scenery: ['belt'] },
    placeOf: ({ kind, index }) => places[kind][index],
  };
  const free = freeCells(world, boundsOf).map(String);
  // The belt lies along x once it is turned: from 1.7 to 3.2.
  assert.deepEqual(free, ['0,1', '1,1', '2,0', '3,0']);
});
