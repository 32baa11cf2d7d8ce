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
  assert.deepEqual(vda5050Of(7, 0), []);
  await new Promise(setImmediate);
  assert.equal(vda5050Of(7, 10).length, 4);
  assert.deepEqual([isVehicle(7), isVehicle(8)], [true, false]);
  assert.deepEqual(vda5050Of(8, 20), []);
  assert.equal(asked, 1);
  vda5050Of(7, 5000);
  assert.equal(asked, 2);
});
