// SPDX-License-Identifier: Apache-2.0
// The last hour of robots and stations: what the server tells, what is in sight, how rows are sorted.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { GanttView, sorted } from '../../../src/warehouse_viewer/web/js/operations/gantt_view.js';
import { Spans } from '../../../src/warehouse_viewer/web/js/operations/spans.js';

/** An answer of the server: `moments` are [time after origin, [[row, state], …]]. */
function answer(head, moments) {
  const text = new TextEncoder().encode(JSON.stringify({ epoch: 1, is_whole: true, origin: 100, moments: moments.length, rows: [], base: [], ...head }));
  const padded = new Uint8Array(Math.ceil(text.length / 4) * 4).fill(32);
  padded.set(text);
  const changes = moments.flatMap(([, rows]) => rows.map(([row, state]) => 8 * row + state));
  const parts = [new Uint32Array([padded.length]), padded, new Float32Array(moments.map(([time]) => time)),
    new Uint32Array(moments.map(([, rows]) => rows.length)), new Uint32Array(changes)];
  const out = new Uint8Array(parts.reduce((sum, { byteLength }) => sum + byteLength, 0));
  let at = 0;
  for (const part of parts) {
    out.set(new Uint8Array(part.buffer), at);
    at += part.byteLength;
  }
  return out.buffer;
}

const FIRST = { last: 2, begin: 100, now: 200, rows: [['robot', 'kiva10'], ['robot', 'kiva2'], ['station', 'pick1']], base: [0, 1, 7] };

function spans() {
  const out = new Spans();
  out.take(answer(FIRST, [[20, [[0, 3], [2, 2]]], [70, [[0, 1]]]]));
  return out;
}

test('rows have the state before the first change, and what changed then', () => {
  const { rows, query } = spans();
  assert.deepEqual(rows.map(({ times, states }) => [times, states]), [[[100, 120, 170], [0, 3, 1]], [[100], [1]], [[120], [2]]]);
  assert.equal(query, 'epoch=1&since=2&known=3');
});

test('what is new is added, and what is older than the hour goes', () => {
  const told = spans();
  told.take(answer({ is_whole: false, last: 3, begin: 150, now: 300, rows: [['robot', 'kiva3']] }, [[150, [[1, 4], [3, 0]]]]));
  assert.deepEqual(told.rows.map(({ times }) => times), [[120, 170], [100, 250], [120], [250]]);
  assert.deepEqual(told.rows[0].span(0, told), { state: 3, from: 150, to: 170 });
  assert.deepEqual(told.rows[1].span(1, told), { state: 4, from: 250, to: 300 });
});

test('shares are of the time that is known', () => {
  const told = spans();
  assert.deepEqual(told.rows[0].shares(told), [0.2, 0.3, 0, 0.5, 0]);
  assert.deepEqual(told.rows[2].shares(told), [0, 0, 1, 0, 0]);
});

test('rows are sorted by name, stations first, or by a share', () => {
  const told = spans(), names = (...how) => sorted(told, ...how).map(({ row }) => row.name);
  assert.deepEqual(names('', 'name'), ['pick1', 'kiva2', 'kiva10']);
  assert.deepEqual(names('robot', 'waiting'), ['kiva10', 'kiva2']);
  assert.equal(sorted(told, '', 'waiting')[0].share, 0.5);
});

test('a zoom keeps the time under the pointer, and ends at the whole hour', () => {
  const view = Object.assign(new GanttView(), { begin: 0, now: 3600, left: 100, width: 1000 });
  assert.deepEqual([view.x(0), view.x(3600)], [100, 1100]);
  view.zoom(0.5, 600);
  assert.ok(Math.abs(view.time(600) - 1800) < 1e-9);
  assert.equal(view.span, 1800);
  view.moveTo(-500);
  assert.equal(view.start, 0);
  view.zoom(100);
  assert.ok(view.isWhole);
});

test('a window that ends now goes on with the time; another stands still', () => {
  const view = Object.assign(new GanttView(), { begin: 0, now: 3600, left: 0, width: 1000 });
  view.zoom(0.25);
  assert.equal(view.start, 2700);
  view.now = 3700;
  assert.equal(view.start, 2800);
  view.moveTo(1000);
  view.now = 3800;
  assert.equal(view.start, 1000);
  view.reveal(3000, 3100);
  assert.ok(view.start <= 3000 && view.start + view.span >= 3100);
});

test('an axis has a few round times before now', () => {
  const view = Object.assign(new GanttView(), { begin: 0, now: 3600, left: 0, width: 1000 });
  assert.deepEqual(view.ticks(8).map(({ ago }) => ago), [0, 600, 1200, 1800, 2400, 3000, 3600]);
  view.zoom(0.05);
  assert.ok(view.ticks(8).length <= 9);
});
