// SPDX-License-Identifier: Apache-2.0
// A station's screen: codes, the scanner, what is kept until it is answered, and what is to be done.

import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { Bench } from '../../../src/warehouse_viewer/web/js/station/bench.js';
import { COMMANDS, meaningOf } from '../../../src/warehouse_viewer/web/js/station/codes.js';
import { Outbox, Refused } from '../../../src/warehouse_viewer/web/js/station/outbox.js';
import { Scanner } from '../../../src/warehouse_viewer/web/js/station/scanner.js';
import { Shelf } from '../../../src/warehouse_viewer/web/js/station/shelf.js';

const WEB = new URL('../../../src/warehouse_viewer/web/', import.meta.url);

/** As localStorage: what it keeps are its own keys. */
class Storage {
  getItem(key) {
    return Object.hasOwn(this, key) ? this[key] : null;
  }

  setItem(key, value) {
    this[key] = String(value);
  }

  removeItem(key) {
    delete this[key];
  }
}

const pick = (sequence, order, tote, quantity = 1, sku = 'sku-4') => (
  { sku, quantity, item: 'item7', order_id: order, reference: `order-${order}`, sequence, tote });
const tote = (position, order, left) => (
  { position, order_id: order, reference: `order-${order}`, lines_left: 1, pieces_left: left, pieces: 3 });
const station = (picks, totes = [], other = {}) => (
  { name: 'pick1', kind: 'PICK', open: true, mode: 'MANUAL', shelf_id: 5, inbound: [], slots: 3, picks, totes, ...other });

/** A bench with what `send` makes of its reports. */
function benchWith(send = () => new Promise(() => {}), storage = new Storage()) {
  const told = { changed() {}, answered: (entry) => bench.answered(entry), refused() {} };
  const outbox = new Outbox('station/pick1/out/', storage, send, told, (_, wake) => setImmediate(wake));
  const bench = new Bench('pick1', new Shelf('station/pick1/', storage), outbox);
  return { bench, outbox, storage };
}

const meaning = (code) => meaningOf(code, 'pick1', ['pick1', 'pick2']);
const settled = () => new Promise((resolve) => { setTimeout(resolve, 20); });

test('a code is a tote of this station or of another one, a button, or goods', () => {
  for (const code of ['T05', 't5', 'pick1-5', 'PICK1-05']) assert.deepEqual(meaning(code), { kind: 'tote', position: 5 });
  assert.equal(meaning('pick2-5').kind, 'other tote');
  assert.equal(meaning('sku-5').kind, 'sku');
  for (const name of COMMANDS) assert.deepEqual(meaning(`CMD-${name}`), { kind: 'command', name });
  assert.equal(meaning('CMD-WIPE').kind, 'sku');
});

test('fast keys that end with Enter are a code, those of a person are not', () => {
  const codes = [], scanner = new Scanner((code) => codes.push(code));
  let now = 0;
  const type = (keys, gap) => keys.map((key) => {
    now += gap;
    return scanner.key(key, now);
  });
  assert.equal(type([...'sku-4', 'Enter'], 5).at(-1), true);
  assert.deepEqual(type([...'sku-4', 'Enter'], 200), [false, false, false, false, false, false]);
  now += 500;
  type([...'T0', 'Shift', '5', 'Enter'], 20);
  assert.deepEqual(codes, ['sku-4', 'T05']);
  type(['Enter'], 5); // alone it presses what has the focus
  assert.equal(scanner.key('Enter', now + 5), false);
});

test('with a prefix a slow code is one, too, and other keys are not', () => {
  const codes = [], scanner = new Scanner((code) => codes.push(code), 'F8');
  let now = 0;
  const type = (...keys) => keys.map((key) => scanner.key(key, now += 400));
  assert.deepEqual(type('a', 'b', 'Enter'), [false, false, false]);
  type('F8', ...'sku-4', 'Enter');
  assert.deepEqual(codes, ['sku-4']);
  type('F8', 'a');
  now += 10_000; // its end never came
  assert.deepEqual(type('b', 'Enter'), [false, false]);
  assert.deepEqual(codes, ['sku-4']);
});

test('a thousand reports over a network that loses two of three come once each, in order', async () => {
  const seen = new Map();
  let turn = 0;
  const { outbox, storage } = benchWith(async ({ sequence, body }) => {
    turn += 1;
    if (turn % 3 === 0) throw new TypeError('the request is lost');
    if (!seen.has(body.id)) seen.set(body.id, sequence);
    if (turn % 3 === 1) throw new TypeError('the answer is lost');
    return {};
  });
  for (let sequence = 1; sequence <= 1000; sequence += 1) outbox.add({ kind: 'report', sequence, body: { id: `id-${sequence}` } });
  while (outbox.entries.length) await settled(); // eslint-disable-line no-await-in-loop
  assert.deepEqual([...seen.values()], Array.from({ length: 1000 }, (_, i) => i + 1));
  assert.deepEqual(Object.keys(storage), []);
});

test('what is kept outlasts a reload, under the same id', async () => {
  const { bench, storage } = benchWith(async () => { throw new TypeError('gone'); });
  bench.take([station([pick(1, 9, 2, 2), pick(2, 8, 3)], [tote(2, 9, 2), tote(3, 8, 2)])]);
  bench.confirm(2);
  const [{ body: { id } }] = bench.outbox.entries;
  await settled();
  const sent = [], again = benchWith(async (entry) => { sent.push(entry); }, storage);
  assert.equal(again.bench.task.sequence, 2); // it goes on with what was told
  again.outbox.run();
  await settled();
  assert.deepEqual(sent.map(({ sequence, body }) => [sequence, body.id, body.quantity]), [[1, id, 2]]);
  assert.equal(again.bench.task.sequence, 2); // not asked for again before the server tells
  again.bench.take([station([pick(2, 8, 3)], [tote(3, 8, 2)])]);
  assert.equal(again.bench.settled.size, 0);
});

test('a refusal ends a report, and the next one goes on', async () => {
  const refused = [], { outbox } = benchWith(async ({ sequence }) => {
    if (sequence === 1) throw new Refused('that is no longer asked for');
  });
  outbox.handlers.refused = ({ sequence }, reason) => refused.push([sequence, reason]);
  for (const sequence of [1, 2]) outbox.add({ kind: 'report', sequence, body: {} });
  await settled();
  assert.deepEqual(refused, [[1, 'that is no longer asked for']]);
  assert.deepEqual(outbox.entries, []);
});

test('each scan counts a piece, and the tote confirms them', () => {
  const { bench } = benchWith();
  bench.take([station([pick(1, 9, 2, 2), pick(2, 8, 3)], [tote(2, 9, 2), tote(3, 8, 2)])]);
  assert.match(bench.scan('sku-5').text, /^sku-5 is wrong: expected sku-4$/);
  assert.match(bench.scan('T02').text, /nothing is in your hand yet: expected sku-4/);
  assert.equal(bench.scan('sku-4').text, '1 of 2 × sku-4: into tote 2');
  assert.equal(bench.scan('T03').text, 'that is tote 3: expected tote 2');
  assert.match(bench.scan('nonsense').text, /expected tote 2, or sku-4 once more/);
  assert.equal(bench.scan('T02').text, '1 of 2 × sku-4 are in tote 2');
  bench.scan('sku-4');
  assert.match(bench.scan('sku-4').text, /^2 × sku-4 are enough/);
  const done = bench.scan('pick1-2');
  assert.deepEqual([done.ok, done.sound], [true, 'complete']);
  assert.deepEqual(bench.outbox.entries.map(({ body }) => [body.order_id, body.quantity]), [[9, 2]]);
  assert.equal(bench.task.sequence, 2);
  const [, complete, lit] = bench.totes;
  assert.deepEqual([complete.left, complete.leaves.reference, lit.isLit], [0, 'order-9', true]);
});

test('what is put in needs no tote', () => {
  const { bench } = benchWith();
  bench.take([station([pick(1, 0, 0, 2)], [], { kind: 'REPLENISH', slots: 0 })]);
  assert.equal(bench.scan('sku-4').text, '1 of 2 × sku-4, 1 more');
  assert.match(bench.scan('T01').text, /no tote is needed/);
  assert.equal(bench.scan('sku-4').sound, 'done');
  assert.equal(bench.scan('sku-4').text, 'nothing is asked for now');
});

test('the last report is taken back: here if it was never sent, else by the server', async () => {
  const { bench, outbox } = benchWith();
  bench.take([station([pick(1, 9, 2), pick(2, 8, 3)], [tote(2, 9, 1), tote(3, 8, 2)])]);
  bench.confirm(1); // is on its way
  bench.confirm(1); // waits behind it
  assert.equal(bench.undo().ok, true);
  assert.equal(bench.task.sequence, 2);
  assert.deepEqual(outbox.entries.map(({ kind }) => kind), ['report']);
  assert.equal(bench.undo().text, 'nothing can be taken back now');
  const other = benchWith();
  other.bench.take([station([pick(1, 9, 2), pick(2, 8, 3)], [tote(2, 9, 1)])]);
  other.bench.confirm(1);
  other.bench.undo();
  assert.deepEqual(other.outbox.entries.map(({ kind, sequence }) => [kind, sequence]), [['report', 1], ['undo', 1]]);
});

test('nothing is taken back of a unit that has left', () => {
  const { bench } = benchWith();
  bench.take([station([pick(1, 9, 2)], [tote(2, 9, 1)])]);
  bench.confirm(1);
  assert.ok(bench.undoable);
  assert.equal(bench.take([station([pick(3, 7, 1)], [tote(1, 7, 1)], { shelf_id: 6 })]), 'arrives');
  assert.equal(bench.undoable, null);
});

test('the tote of an order that has left is to be emptied', () => {
  const { bench } = benchWith();
  bench.take([station([pick(1, 9, 2)], [tote(1, 7, 1), tote(2, 9, 1)])]);
  bench.take([station([pick(1, 9, 2)], [tote(2, 9, 1)])]);
  assert.equal(bench.totes[0].leaves.text, 'not ours any more: empty it');
  assert.equal(bench.totes[2].leaves, null);
});

test('the worker keeps every file of the page', () => {
  const worker = readFileSync(new URL('js/station/worker.js', WEB), 'utf8');
  const files = readdirSync(new URL('js/station/', WEB)).filter((name) => name !== 'worker.js');
  const used = new Set(files.map((name) => `station/${name.slice(0, -3)}`));
  for (const name of used) { // what is added meanwhile is read, too
    const module = new URL(`js/${name}.js`, WEB);
    for (const [, path] of readFileSync(module, 'utf8').matchAll(/from '(\.[^']+)\.js'/g)) {
      used.add(new URL(path, module).href.slice(new URL('js/', WEB).href.length));
    }
  }
  const rooms = worker.match(/MODULES = \{(.*?)\n\};/s)[1].matchAll(/(\w+): \[(.*?)\]/gs);
  const kept = [...rooms].flatMap(([, room, names]) => [...names.matchAll(/'(\w+)'/g)].map(([, name]) => `${room}/${name}`));
  assert.deepEqual(kept.sort(), [...used].sort());
});
