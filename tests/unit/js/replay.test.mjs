// SPDX-License-Identifier: Apache-2.0
// A recording in the browser: its chunks, moments in between, addresses of moments, and playing.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { read } from '../../../src/warehouse_viewer/web/js/replay/chunk.js';
import { clock, readClock } from '../../../src/warehouse_viewer/web/js/base/time.js';
import { linkTo, lookOf, momentOf, timeOf, wallAt } from '../../../src/warehouse_viewer/web/js/replay/link.js';
import { Player } from '../../../src/warehouse_viewer/web/js/replay/player.js';
import { rowsOf } from '../../../src/warehouse_viewer/web/js/replay/forecast.js';
import { Recording } from '../../../src/warehouse_viewer/web/js/replay/recording.js';
import { State } from '../../../src/warehouse_viewer/web/js/replay/state.js';
import { AT, table } from './scene/look.mjs';

const ROBOT = 7, BODY = 9;
const SCENE = { robots: [1, 2], units: ['storage_unit1'], items: [], scenery: [] };
const none = table([], BODY, [0, 8]);

/** An update with rows [index, x, y, yaw] of robots. */
function update(stamp, robots, units = []) {
  return { kind: 'update', stamp, revision: 1, loose: none, scenery: none,
    robots: table(robots.map((row) => [...row, 0, 0, 0]), ROBOT, [0, 4, 5]),
    units: table(units, BODY, [0, 8]) };
}

/** {index: [x, y, yaw]} of the robots in an update. */
function placesIn({ robots: { count, words, f32, i32 } }) {
  return Object.fromEntries(Array.from({ length: count }, (_, row) => (
    [i32[row * words], [...f32.subarray(row * words + 1, row * words + 4)]])));
}

/** The bytes of a message in a chunk. */
function message(kind, stamp, data) {
  const out = new DataView(new ArrayBuffer(16 + 8 * Math.ceil(data.length / 8)));
  out.setUint32(0, kind, true);
  out.setUint32(4, data.length, true);
  out.setFloat64(8, stamp, true);
  new Uint8Array(out.buffer).set(data, 16);
  return new Uint8Array(out.buffer);
}

/** An update without rows, as protocol.py writes it. */
function empty(stamp) {
  const out = new DataView(new ArrayBuffer(40));
  out.setUint32(0, 1, true);
  out.setFloat64(8, stamp, true);
  return new Uint8Array(out.buffer);
}

const text = (told) => new TextEncoder().encode(JSON.stringify(told));
const joined = (...parts) => Uint8Array.from(parts.flatMap((part) => [...part])).buffer;

test('a chunk has updates and texts, each with its time', () => {
  const { updates, texts } = read(joined(message(4, 30, text({ type: 'past', events: [] })),
    message(1, 30.5, empty(30.5))));
  assert.deepEqual(texts, [{ stamp: 30, message: { type: 'past', events: [] } }]);
  assert.deepEqual(updates.map(({ stamp }) => stamp), [30.5]);
});

test('a chunk that was cut off is an error that says where', () => {
  const whole = new Uint8Array(joined(message(1, 1, empty(1)), message(4, 1, text({ type: 'past' }))));
  assert.throws(() => read(whole.slice(0, 70).buffer), /damaged: byte 56/);
  assert.throws(() => read(whole.slice(0, 60).buffer), /damaged: byte 56/);
});

test('robots are on their way between two updates, and turn the short way', () => {
  const state = new State();
  state.setScene(SCENE);
  state.take(update(10, [[0, 1, 0, 3], [1, 5, 5, 0]]));
  const next = update(10.5, [[0, 2, 0, -3]]);
  const [x, , yaw] = placesIn(state.at(10.25, next))[0];
  assert.ok(Math.abs(x - 1.5) < 1e-6 && Math.abs(yaw - Math.PI) < 0.01, `${x} ${yaw}`);
  // Who stands is told once.
  assert.deepEqual(Object.keys(placesIn(state.at(10.3, next))), ['0']);
});

test('who was put elsewhere does not drive there', () => {
  const state = new State();
  state.setScene(SCENE);
  state.take(update(10, [[0, 1, 0, 0]]));
  assert.equal(placesIn(state.at(10.4, update(10.5, [[0, 40, 0, 0]])))[0][0], 1);
});

test('units change hands when their update is due, not before', () => {
  const state = new State();
  state.setScene(SCENE);
  state.take(update(10, [[0, 1, 0, 0]], [[0, ...AT(1, 2), 0]]));
  state.at(10, null);
  const next = update(10.5, [[0, 1, 0, 0]], [[0, ...AT(0, 0), 1]]);
  assert.equal(state.at(10.4, next).units.count, 0);
  state.take(next);
  const { units } = state.at(10.5, null);
  assert.equal(units.i32[8], 1);
});

test('an address names a moment by seconds or by the clock', () => {
  assert.deepEqual(momentOf('#t=630.5'), { t: 630.5 });
  assert.deepEqual(momentOf('#at=10:42'), { clock: 38520 });
  assert.deepEqual(momentOf('#at=0:00:07'), { clock: 7 });
  for (const other of ['', '#sku-17', '#t=', '#t=soon', '#at=25:61', '#at=noon']) assert.equal(momentOf(other), null);
  assert.equal(linkTo('http://here/#sku-1', 630.46), 'http://here/#t=630.5');
  assert.deepEqual(momentOf(linkTo('http://here/', 12.3).slice('http://here/'.length)), { t: 12.3 });
});

test('a link holds what is selected and from where it is looked at', () => {
  const view = { position: [1, -2.004, 3.5], target: [0, 0.126, 0], zoom: 0 };
  const link = linkTo('http://here/', 12.3, { name: 'kiva7', view });
  assert.equal(link, 'http://here/#t=12.3&see=kiva7&from=1,-2,3.5,0,0.13,0');
  const hash = link.slice('http://here/'.length);
  assert.deepEqual(momentOf(hash), { t: 12.3 });
  assert.deepEqual(lookOf(hash), { name: 'kiva7', view: { position: [1, -2, 3.5], target: [0, 0.13, 0], zoom: 0 } });
  const above = linkTo('http://here/', 1, { view: { ...view, zoom: 41.5 } });
  assert.equal(lookOf(above.slice('http://here/'.length)).view.zoom, 41.5);
  for (const wrong of ['', '#t=1', '#t=1&from=', '#t=1&from=1,2,3', '#t=1&from=1,2,3,4,5,x', '#t=1&from=1,2,3,4,5,6,-1']) {
    assert.deepEqual(lookOf(wrong), { name: null, view: null });
  }
});

const at = (hour, minute) => new Date(2026, 10, 23, hour, minute).getTime() / 1000;

test('the clock on the wall is that of the chunk, at its pace', () => {
  const chunks = [{ begin: 0, end: 600, wall: at(10, 40) }, { begin: 600, end: 1200, wall: at(10, 45) }];
  assert.equal(timeOf({ clock: readClock('10:42') }, chunks), 240); // two simulated seconds a second
  assert.equal(wallAt(240, chunks), at(10, 42));
  assert.equal(timeOf({ clock: readClock('0:05') }, [{ begin: 0, end: 600, wall: null }]), 300);
  assert.equal(wallAt(5, [{ begin: 0, end: 600, wall: null }]), null);
  assert.equal(clock(3725.9), '1:02:05');
});

/** The bytes of a chunk of 30 s, in which robot 0 drives 0.1 m/s, with an event. */
function content(begin) {
  return joined(
    message(4, begin, text({ type: 'past', events: [{ id: begin, time: begin }] })),
    message(1, begin, moving(begin)),
    message(4, begin + 10, text({ type: 'events', events: [{ id: begin + 1, time: begin + 10 }] })),
    message(4, begin + 10, text({ type: 'figures', kpis: { orders_completed: begin } })),
    message(1, begin + 15, moving(begin + 15)));
}

/** A server with two such chunks. */
function server(asked = []) {
  const index = { id: 'a', live: false, about: {}, cut: '', open: 0, begin: 0, end: 60,
    chunks: [[1, 9, 0, 29.5, null], [2, 9, 30, 60, null]], marks: [] };
  return async (path) => {
    asked.push(path);
    const body = path.includes('scenes') ? SCENE : path.includes('index') ? index : null;
    return { ok: true, status: 200, json: async () => body,
      arrayBuffer: async () => content(path.includes('chunks/2') ? 30 : 0) };
  };
}

/** An update with robot 0 at x = stamp / 10, as protocol.py writes it. */
function moving(stamp) {
  const out = new DataView(new ArrayBuffer(40 + 28));
  new Uint8Array(out.buffer).set(empty(stamp));
  out.setUint32(20, 1, true);
  out.setFloat32(44, stamp / 10, true);
  return new Uint8Array(out.buffer);
}

async function player(asked) {
  const shown = { events: [], updates: [], resets: 0 };
  const recording = new Recording(server(asked));
  await recording.refresh();
  const it = new Player(recording, {
    scene: (scene) => { shown.scene = scene; }, reset: () => { shown.resets += 1; },
    update: (one) => shown.updates.push(one), past: (events) => { shown.events = events; },
    events: (events) => shown.events.push(...events), figures: ({ kpis }) => { shown.done = kpis.orders_completed; },
  }, { changed: () => {}, failed: (error) => { shown.error = error.message; }, now: () => shown.now ?? 0 });
  return { it, shown };
}

test('seeking shows that moment, its events and figures, from one chunk', async () => {
  const asked = [];
  const { it, shown } = await player(asked);
  await it.seek(41);
  assert.deepEqual(asked.slice(1), ['/recording/chunks/2?of=a', '/recording/scenes/9?of=a']);
  assert.equal(shown.scene.revision, 9);
  assert.ok(Math.abs(placesIn(shown.updates.at(-1))[0][0] - 4.1) < 1e-6);
  assert.deepEqual(shown.events.map(({ id }) => id), [30, 31]);
  assert.equal(shown.done, 30);
  await it.seek(5); // back
  assert.ok(Math.abs(placesIn(shown.updates.at(-1))[0][0] - 0.5) < 1e-6);
  assert.deepEqual(shown.events.map(({ id }) => id), [0]);
});

test('a forecast has a row for each sixth of its time', () => {
  const time = Array.from({ length: 60 }, (_, i) => 120 + 60 * (i + 1));
  const band = { p10: time.map(() => 1), p50: time.map((_, i) => 1000 + i), p90: time.map(() => 3.4) };
  const rows = rowsOf({ time, done: band, open: band, late: band });
  assert.deepEqual(rows.map((row) => row.at), ['0:12:00', '0:22:00', '0:32:00', '0:42:00', '0:52:00', '1:02:00']);
  assert.match(rows[5].done, /^1.?059 \(1 to 3\)$/);
  assert.equal(rowsOf({ time: [60], done: band, open: band, late: band }).length, 1);
});

test('playing goes on into the next chunk, and ends with the recording', async () => {
  const { it, shown } = await player();
  await it.seek(28);
  it.play();
  clearInterval(it.timer);
  it.speed = 10;
  shown.now = 400;
  await it.tick(); // 4 s later
  assert.equal(it.time, 32);
  assert.ok(Math.abs(placesIn(shown.updates.at(-1))[0][0] - 3.2) < 1e-6);
  assert.equal(shown.resets, 1); // it did not jump
  shown.now = 60_000;
  await it.tick();
  assert.equal(it.time, 60);
  assert.equal(it.isPlaying, false);
});

test('a chunk that can not be had is told, and asked for again', async () => {
  const { it, shown } = await player();
  const { ask } = it.recording;
  it.recording.ask = async (path) => (path.includes('chunks')
    ? { ok: false, status: 500, json: async () => ({ detail: 'byte 7: the block is damaged' }) } : ask(path));
  await it.seek(3);
  assert.match(shown.error, /byte 7/);
  it.recording.ask = ask;
  await it.seek(3);
  assert.equal(shown.updates.length, 1);
});
