// SPDX-License-Identifier: Apache-2.0
// Many copies in one mesh are where instances of the same would be.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Instances, Merged } from '../../../../src/warehouse_viewer/web/js/scene/copies.js';
import { hull, materialOf } from '../../../../src/warehouse_viewer/web/js/scene/looks.js';
import * as THREE from '/three/build/three.module.js';
import { ROBOT } from './look.mjs';

const COUNT = 70; // more than a mesh has room for at first
const matrices = new Float32Array(16 * COUNT), tints = new Float32Array(4 * COUNT);
for (let i = 0; i < COUNT; ++i) {
  new THREE.Matrix4().makeRotationZ(i).setPosition(i, -2 * i, 0.5).toArray(matrices, 16 * i);
  tints.set([i / COUNT, 0, 1, i % 3], 4 * i);
}

/** Draws some of the copies, each raised by a metre. */
function drawn(copies, indices) {
  copies.begin();
  for (const i of indices) copies.add(matrices, tints, i, (_, out, at) => { out[at + 14] += 1; });
  copies.end();
  return copies;
}

/** [x, y, z, normal x, y, z, tint r, g, b] of each corner that is drawn, of instances. */
function cornersOf({ mesh: { geometry, instanceMatrix, count } }) {
  const { position, normal, tint } = geometry.attributes, out = [];
  for (let copy = 0; copy < count; ++copy) {
    const matrix = new THREE.Matrix4().fromArray(instanceMatrix.array, 16 * copy);
    for (const i of geometry.index.array) {
      const at = new THREE.Vector3().fromArray(position.array, 3 * i).applyMatrix4(matrix);
      const up = new THREE.Vector3().fromArray(normal.array, 3 * i).transformDirection(matrix);
      out.push([...at.toArray(), ...up.toArray(), ...tint.array.slice(4 * copy, 4 * copy + 4)]);
    }
  }
  return out;
}

/** The same of one mesh. */
function mergedCorners({ mesh: { geometry } }) {
  const { position, normal, tint } = geometry.attributes;
  return Array.from(geometry.index.array.slice(0, geometry.drawRange.count), (i) => (
    [position, normal, tint].flatMap(({ array, itemSize }) => Array.from(array.slice(itemSize * i, itemSize * (i + 1))))));
}

test('one mesh has the corners, normals and colours of the instances, whichever are drawn', () => {
  const instances = new Instances(hull(ROBOT, true, 0.4), materialOf(true));
  const merged = new Merged(hull(ROBOT, true, 0.4), materialOf(true));
  for (const indices of [[...Array(COUNT).keys()], [3], [], [69, 2, 40]]) {
    const [expected, got] = [cornersOf(drawn(instances, indices)), mergedCorners(drawn(merged, indices))];
    assert.equal(got.length, expected.length);
    expected.forEach((corner, i) => corner.forEach((value, k) => (
      assert.ok(Math.abs(value - got[i][k]) < 1e-4, `corner ${i}: ${got[i]}, not ${corner}`))));
    assert.equal(merged.mesh.visible, indices.length > 0);
  }
});
