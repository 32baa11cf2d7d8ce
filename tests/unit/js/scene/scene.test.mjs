// SPDX-License-Identifier: Apache-2.0
// What the picture is made of: shelves, tiles of the floor, arrows, signs; and the way by keys.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Renewal, STILL } from '../../../../src/warehouse_viewer/web/js/scene/backdrop.js';
import { FAR, NEAR, StandingCrowd, View } from '../../../../src/warehouse_viewer/web/js/scene/crowd.js';
import { scaleFor } from '../../../../src/warehouse_viewer/web/js/scene/fit.js';
import { boundsOf, hull, merge } from '../../../../src/warehouse_viewer/web/js/scene/looks.js';
import { apart } from '../../../../src/warehouse_viewer/web/js/scene/labelled.js';
import { chevrons } from '../../../../src/warehouse_viewer/web/js/scene/paint.js';
import { nextFrom } from '../../../../src/warehouse_viewer/web/js/scene/scene_keys.js';
import { boardsOf, shelfGeometry, shelfPicture, variantOf, VARIANTS } from '../../../../src/warehouse_viewer/web/js/scene/shelves.js';
import { signOf } from '../../../../src/warehouse_viewer/web/js/scene/signs.js';
import * as THREE from '/three/build/three.module.js';
import { AT, UNIT } from './look.mjs';

const board = (z) => ({ kind: 0, pose: AT(0, 0, z), size: [0.8, 0.8, 0.03], colour: [1, 1, 1, 1] });
const SHELF = [{ name: 'shelf', pose: AT(), shapes: [
  { kind: 0, pose: AT(0.38, 0.38, 0.9), size: [0.04, 0.04, 1.8], colour: [0, 0, 0, 1] }, board(1.35), board(0.45)] }];

function viewFrom(height, x = 0) {
  const camera = new THREE.PerspectiveCamera(90, 1, 0.1, 2000);
  camera.position.set(x, 0, height);
  camera.lookAt(x, 0, 0);
  camera.updateProjectionMatrix();
  const view = new View();
  view.update(camera, 1000);
  return view;
}

test('boards are found in a look, from below, as parts of its height', () => {
  boardsOf(SHELF).forEach((at, i) => assert.ok(Math.abs(at - [0.25, 0.75][i]) < 1e-9));
  assert.deepEqual(boardsOf(UNIT), []);
});

test('a shelf has a picture as full as it is', () => {
  const { image: { data, width } } = shelfPicture(boardsOf(SHELF));
  const goods = (variant) => {
    let count = 0;
    for (let y = 0; y < 128; ++y) for (let x = 0; x < 64; ++x) {
      const at = 4 * (y * width + 64 * variant + x);
      if (data[at + 3] === 0 && data[at] !== 74) count += 1;
    }
    return count;
  };
  assert.equal(width, 64 * VARIANTS);
  assert.equal(goods(variantOf(0, 3)), 0);
  assert.ok(goods(variantOf(1, 3)) > goods(variantOf(0.34, 3)) && goods(variantOf(0.34, 3)) > 0);
  assert.equal(shelfGeometry(SHELF).index.count, 5 * 6);
});

/** 200 units on two squares of the floor. */
function standing() {
  const crowd = new StandingCrowd(new THREE.Group(), 200, boundsOf(UNIT), 100, 0);
  crowd.add(merge(UNIT), null, NEAR);
  crowd.add(hull(UNIT), null, FAR);
  const matrix = new THREE.Matrix4(), place = (i, x, moves) => crowd.put(i, matrix.makeTranslation(x, 0.5, 0), moves);
  for (let i = 0; i < 200; ++i) place(i, i < 100 ? 1 : 33);
  crowd.fill(viewFrom(40, 17), true, true);
  return { crowd, place, counts: () => crowd.parts.map(({ copies }) => copies[1]?.drawn ?? 0) };
}

test('what stands on a square of the floor is drawn again only when something there changes', () => {
  const { crowd, place, counts } = standing();
  assert.deepEqual(counts(), [0, 100, 100]);
  const seen = crowd.parts[2].copies[1].mesh.geometry.attributes.position.version;
  place(5, 1, true); // it is lifted
  crowd.fill(viewFrom(40, 17), false, true);
  assert.deepEqual(counts(), [1, 99, 100]);
  assert.equal(crowd.parts[2].copies[1].mesh.geometry.attributes.position.version, seen);
  place(5, 33);
  crowd.fill(viewFrom(40, 17), false, true);
  assert.deepEqual(counts(), [0, 99, 101]);
  crowd.fill(viewFrom(40, 5000), true, true);
  assert.ok(crowd.parts.slice(1).every(({ copies }) => !copies[1].mesh.visible));
  crowd.fill(viewFrom(40, 17), true, true);
  assert.ok(crowd.parts.slice(1).every(({ copies }) => copies[1].mesh.visible));
});

test('a square of the floor is seen as large as its nearest edge, whatever stands there', () => {
  const view = viewFrom(21); // 500 px a metre at 1 m, 1 m above the floor
  for (const reach of [8 * Math.SQRT2, 8 * Math.SQRT2 + 1]) {
    assert.ok(Math.abs(view.scaleOfSquare(8, 8, 8, reach) - 500 / 20) < 1e-6); // beneath it
    assert.ok(Math.abs(view.scaleOfSquare(23, 8, 8, reach) - 500 / 25) < 1e-6); // 15 m aside
    assert.equal(view.scaleOfSquare(80, 0, 8, reach), 0); // out of sight
  }
});

test('what was put down moves on until the backdrop takes it in, and is nowhere missing', () => {
  const { crowd, place, counts } = standing();
  const shows = (moved, settles) => {
    crowd.fill(viewFrom(40, 17), moved, settles);
    return counts();
  };
  assert.equal(crowd.isUnsettled, false);
  place(5, 1, true);
  assert.equal(crowd.isUnsettled, true);
  assert.deepEqual(shows(false, false), [1, 100, 100]); // the backdrop has it, too
  assert.deepEqual(shows(false, true), [1, 99, 100]);
  assert.equal(crowd.isUnsettled, false);
  place(5, 33);
  assert.deepEqual(shows(false, false), [1, 99, 100]);
  place(5, 34, true); // lifted again before
  assert.deepEqual(shows(false, true), [1, 99, 100]);
  place(5, 33);
  assert.deepEqual(shows(false, true), [0, 99, 101]);
});

test('only what stands is in the backdrop, unless one sees through it', () => {
  const { crowd, place } = standing(), layers = () => crowd.parts.map(({ copies }) => copies[1].mesh.layers.mask);
  place(5, 1, true);
  crowd.fill(viewFrom(40, 17), false, true);
  assert.deepEqual(layers(), [1, 1 << STILL, 1 << STILL]);
  crowd.setStill(false);
  assert.deepEqual(layers(), [1, 1, 1]);
});

test('the backdrop is drawn at once for another view, and for what came or went after a while', () => {
  const renewal = new Renewal();
  assert.ok(renewal.settles(0, false) && renewal.take(0));
  assert.ok(!renewal.settles(100, true) && !renewal.take(100));
  renewal.ask();
  assert.ok(renewal.settles(200, false) && renewal.take(200));
  assert.ok(!renewal.settles(600, true) && !renewal.settles(900, false));
  assert.ok(renewal.settles(700, true) && renewal.take(700) && !renewal.take(701));
});

test('a floor from above fits its room whichever side is up', () => {
  assert.equal(scaleFor([-10, 10, -5, 5], Math.PI / 2, [200, 200]), 10);
  assert.equal(scaleFor([-10, 10, -5, 5], 0, [100, 200]), 10);
});

test('an arrow points where it should', () => {
  const { position } = chevrons([2, 3, Math.PI / 2]).attributes;
  const points = Array.from({ length: position.count }, (_, i) => [position.getX(i), position.getY(i)]);
  const [tip] = points.sort((a, b) => b[1] - a[1]);
  assert.ok(Math.abs(tip[0] - 2) < 1e-6 && tip[1] > 3.1);
});

test('a sign tells who queues, and from when on a person is wanted', () => {
  assert.deepEqual(signOf(4, { open: true, waiting: 0 }), { kind: 'sign', note: '4' });
  assert.deepEqual(signOf(0, undefined), { kind: 'sign', note: '' });
  assert.deepEqual(signOf(4, { open: true, waiting: 12.5 }), { kind: 'sign waiting', note: '4 · 12 s' });
  assert.deepEqual(signOf(4, { open: true, waiting: 150 }), { kind: 'sign needs-help', note: '4 · 2 min' });
  assert.deepEqual(signOf(0, { open: false, waiting: 0 }), { kind: 'sign', note: 'closed' });
});

const sign = (text, x, y, note = '', kind = 'sign') => ({ text, note, kind, pixel: [x, y] });
const shown = (...signs) => apart(signs).map(({ text }) => text);

test('of signs that would cover each other the first is shown, whatever it counts', () => {
  assert.deepEqual(shown(sign('pick1', 0, 0), sign('pick2', 40, 15), sign('pick3', 40, 30)), ['pick1', 'pick3']);
  assert.deepEqual(shown(sign('pick1', 0, 0), sign('pick2', 90, 0)), ['pick1', 'pick2']);
  assert.deepEqual(shown(sign('pick1', 0, 0, '12'), sign('pick2', 90, 0, '3')), ['pick1', 'pick2']);
  assert.deepEqual(shown(sign('pick1', 0, 0), sign('pick2', 90, 0, 'closed · 3 min')), ['pick1']);
  assert.deepEqual(shown(sign('pick1', 0, 0), sign('pick2', 40, 15, '4 · 2 min', 'sign needs-help')), ['pick2']);
});

test('arrow keys go to the next robot as they are seen', () => {
  const points = [[0, 0], [10, 1], [30, 0], [12, 40], [-5, 0]];
  assert.equal(nextFrom([0, 0], [1, 0], points, 0), 1);
  assert.equal(nextFrom([10, 1], [1, 0], points, 1), 2);
  assert.equal(nextFrom([0, 0], [-1, 0], points, 0), 4);
  assert.equal(nextFrom([0, 0], [0, 1], points, 0), 3);
  assert.equal(nextFrom([30, 0], [1, 0], points, 2), -1);
  assert.equal(nextFrom([28, 0], [0, 1], points), 2);
});
