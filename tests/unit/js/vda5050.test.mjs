// SPDX-License-Identifier: Apache-2.0
// What the panel of a selected robot tells of VDA 5050.

import assert from 'node:assert/strict';
import test from 'node:test';

import { factsOf, isVehicle, vda5050Of } from '../../../src/warehouse_viewer/web/js/panels/vda5050.js';

const ROBOT = { id: 7, driven_by: 'OUTSIDE_MASTER', manufacturer: 'kiva', serial: '7', broker: 'host:1883',
  connection: 'ONLINE', driven: true, order: 'fetch', errors: ['orderError: off the floor'] };

test('a robot at a broker has its master, connection, order and errors', () => {
  assert.deepEqual(factsOf(ROBOT), [
    ['VDA 5050', 'kiva/7 at host:1883: online'],
    ['driven by', 'an outside master'],
    ['order', 'fetch'],
    ['error', 'orderError: off the floor'],
  ]);
});

test('faults on demand are among its facts', () => {
  const faulty = { ...ROBOT, errors: [], faults: ['lost', 'error:WARNING'] };
  assert.deepEqual(factsOf(faulty).slice(-2), [['fault', 'lost'], ['fault', 'error:WARNING']]);
});

test('without an order it says so', () => {
  const free = { ...ROBOT, driven: false, order: '', errors: [], connection: 'CONNECTIONBROKEN' };
  assert.deepEqual(factsOf(free), [
    ['VDA 5050', 'kiva/7 at host:1883: connection broken'],
    ['driven by', 'no outside master now'],
  ]);
  assert.equal(factsOf({ ...free, driven_by: 'COORDINATOR' })[1][1], 'this warehouse');
});

test('the server is asked now and then; robots at no broker have no facts', async () => {
  let asked = 0;
  globalThis.fetch = async (path) => {
    assert.equal(path, '/api/v1/vda5050');
    asked += 1;
    return { ok: true, json: async () => [ROBOT] };
  };
  assert.deepEqual(vda5050Of(7, { now: 0 }), []);
  await new Promise(setImmediate);
  assert.equal(vda5050Of(7, { now: 10 }).length, 4);
  assert.deepEqual([isVehicle(7), isVehicle(8)], [true, false]);
  assert.deepEqual(vda5050Of(8, { now: 20 }), []);
  assert.equal(asked, 1);
  vda5050Of(7, { now: 5000 });
  assert.equal(asked, 2);
});

test('at a past moment the recording is asked, and what is of now is not shown', async () => {
  const past = { update: 1, last_node: 'c2_0', base: ['c3_0'], horizon: ['c4_0', 'c5_0'], driving: true, paused: false,
    mode: 'AUTOMATIC', actions: ['pick WAITING'], age: 0.4 };
  const paths = [];
  let changes = 0;
  const at = (wall) => vda5050Of(7, { now: 9000, past: wall, changed: () => { changes += 1; } });
  globalThis.fetch = async (path) => {
    paths.push(path);
    return { ok: true, json: async () => [{ ...ROBOT, order: 'o', past }] };
  };
  assert.deepEqual(at(100), []);
  await new Promise(setImmediate);
  assert.equal(changes, 1);
  const facts = Object.fromEntries(at(100.1));
  assert.equal(facts.order, 'o, update 1');
  assert.equal(facts.base, 'c3_0 (1)');
  assert.equal(facts.horizon, 'c4_0 → c5_0 (2)');
  assert.equal(facts.state, 'driving, AUTOMATIC, 0.4 s old');
  assert.equal(facts.action, 'pick WAITING');
  at(101);
  assert.deepEqual(paths, ['/recording/vda5050?at=100.000', '/recording/vda5050?at=101.000']);
  await new Promise(setImmediate);
  assert.deepEqual(at(undefined), []);
  assert.deepEqual(vda5050Of(7, { now: 9001 }), []);
  assert.equal(paths.at(-1), '/api/v1/vda5050');
});

test('a vehicle of 3.0.0 says where it will drive and when it will be there', () => {
  const planning = { ...ROBOT, order: '', errors: [], driven_by: 'COORDINATOR', planned_path: [[0, 0], [2, 0]],
    intermediate_path: [{ x: 1, y: 0, time: 1_700_000_000 }] };
  const [path, reaches] = factsOf(planning).slice(-2);
  assert.deepEqual(path, ['planned path', '2 points']);
  assert.equal(reaches[0], 'reaches');
  assert.match(reaches[1], /^1\.0, 0\.0 m at .*\d/);
});
