// SPDX-License-Identifier: Apache-2.0
// What is hit, seen large and seen at all.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from '/three/build/three.module.js';
import { Crowd, FAR, NEAR, View } from '../../../../src/warehouse_viewer/web/js/scene/crowd.js';
import { labelled } from '../../../../src/warehouse_viewer/web/js/scene/labelled.js';
import { boundsOf, boxesOf, hull, largestOf, merge } from '../../../../src/warehouse_viewer/web/js/scene/looks.js';
import { enters } from '../../../../src/warehouse_viewer/web/js/scene/picker.js';
import { rolledBy, wheelsOf } from '../../../../src/warehouse_viewer/web/js/scene/robots.js';
import { ROBOT, UNIT } from './look.mjs';

const ray = (origin, direction) => ({ origin: new THREE.Vector3(...origin), direction: new THREE.Vector3(...direction) });

test('a ray meets a box at its near face, and not beside it', () => {
  const half = [1, 2, 3];
  assert.equal(enters(ray([-5, 0, 0], [1, 0, 0]), half), 4);
  assert.equal(enters(ray([0, 0, 0], [1, 0, 0]), half), 0);
  assert.equal(enters(ray([-5, 2.1, 0], [1, 0, 0]), half), Infinity);
  assert.equal(enters(ray([5, 0, 0], [1, 0, 0]), half), Infinity);
  assert.ok(Math.abs(enters(ray([-2, -3, 0], [0.6, 0.8, 0]), half) - 1 / 0.6) < 1e-9);
});

test('the size of a look is that of its shapes where they are', () => {
  const { min, max, centre, radius } = boundsOf(UNIT);
  assert.deepEqual([min, max].map((p) => p.map((x) => Math.round(10 * x) / 10)), [[-0.4, -0.4, 0.4], [0.4, 0.4, 1.8]]);
  assert.ok(Math.abs(centre[2] - 1.1) < 1e-9 && Math.abs(radius - Math.hypot(0.4, 0.4, 0.7)) < 1e-9);
  assert.equal(boundsOf([]).radius, 0);
  // A wheel lies on its side.
  assert.ok(Math.abs(boundsOf(ROBOT.slice(1, 2)).max[1] - 0.285) < 1e-9);
});

test('a look becomes one geometry, whose largest shape takes the tint', () => {
  const geometry = merge(ROBOT.slice(0, 1), true);
  const { position, paint } = geometry.attributes;
  assert.equal(position.count, 2 * 36);
  assert.equal(paint.array.reduce((a, b) => a + b), 36);
  assert.deepEqual(largestOf(ROBOT).size, [0.7, 0.6, 0.3]);
  assert.equal(hull(ROBOT).index.count, 5 * 6);
  assert.equal(hull(ROBOT, true, 0.5).index.count, 6 * 6);
  assert.equal(boxesOf(ROBOT).length, 4);
});

test('the sides of a hull are seen from outside', () => {
  const { index, attributes: { position, normal } } = hull(UNIT);
  const at = (array, i) => new THREE.Vector3().fromBufferAttribute(array, index.getX(i));
  for (let i = 0; i < index.count; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => at(position, i + k));
    const across = b.sub(a).cross(c.sub(a)).normalize();
    assert.ok(across.distanceTo(at(normal, i)) < 1e-6, `triangle ${i / 3}`);
  }
});

test('wheels roll by the way, and against each other in a turn', () => {
  const wheels = wheelsOf(ROBOT);
  assert.ok(Math.abs(wheels.radius - 0.1) < 1e-9 && Math.abs(wheels.track - 0.52) < 1e-9);
  const [left, right] = rolledBy([0, 0, Math.PI / 2], [0, 0.2, Math.PI / 2], wheels);
  assert.ok(Math.abs(left - 2) < 1e-9 && Math.abs(right - 2) < 1e-9);
  const [inner, outer] = rolledBy([0, 0, 0], [0, 0, 0.01], wheels);
  assert.ok(inner < 0 && Math.abs(outer + inner) < 1e-12);
});

/** A camera above the origin that looks straight down, on a picture of 1000 x 1000. */
function above(height) {
  const camera = new THREE.PerspectiveCamera(90, 1, 0.1, 1000);
  camera.position.set(0, 0, height);
  camera.lookAt(0, 0, 0);
  camera.updateProjectionMatrix();
  const view = new View();
  view.update(camera, 1000);
  return { view, camera };
}

test('a view tells how large a thing is seen, and whether', () => {
  const { view, camera } = above(10);
  assert.ok(Math.abs(view.scaleAt(0, 0, 0, 1) - 50) < 1e-6);
  assert.equal(view.scaleAt(12, 0, 0, 1), 0);
  assert.ok(view.scaleAt(10.5, 0, 0, 1) > 0);
  assert.equal(view.update(camera, 1000), false);
  camera.position.x = 1;
  assert.equal(view.update(camera, 1000), true);
});

test('of a crowd the near are drawn in detail, the far as boxes, and those out of sight not', () => {
  const many = 10000;
  const crowd = new Crowd(new THREE.Group(), many, boundsOf(UNIT), 30);
  crowd.add(merge(UNIT), null, NEAR);
  crowd.add(hull(UNIT), null, FAR);
  const matrix = new THREE.Matrix4();
  for (let i = 0; i < many; ++i) crowd.put(i, matrix.makeTranslation(i < 10 ? 0.5 * i : 1000, 0, 0));
  const drawn = () => crowd.layers.map((_, layer) => crowd.parts[0].copies[layer]?.drawn ?? 0);
  crowd.fill(above(10).view, true);
  assert.deepEqual(drawn(), [10, 0]);
  crowd.fill(above(50).view, true);
  assert.deepEqual(drawn(), [0, 10]);
  crowd.put(3, matrix.makeTranslation(-1000, 0, 0));
  crowd.fill(above(50).view, false);
  assert.deepEqual(drawn(), [0, 9]);
});

test('a few are always drawn in detail', () => {
  const crowd = new Crowd(new THREE.Group(), 3, boundsOf(UNIT), 30);
  crowd.add(merge(UNIT), null, NEAR);
  for (let i = 0; i < 3; ++i) crowd.put(i, new THREE.Matrix4());
  crowd.fill(above(300).view, true);
  assert.equal(crowd.parts[0].copies[0].drawn, 3);
});

test('labels: names for who is wanted or needs help, numbers for who is seen large', () => {
  const world = { shown: Float64Array.from([0, 0, 0, 1, 0, 0, 2, 0, 0, 100, 0, 0]), activity: Uint8Array.of(0, 1, 4, 4) };
  assert.deepEqual(labelled(world, above(5).view, new Set([1])), { names: [1, 2], numbers: [0] });
  assert.deepEqual(labelled(world, above(50).view, new Set()), { names: [2], numbers: [] });
});
