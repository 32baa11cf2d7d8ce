// SPDX-License-Identifier: Apache-2.0
// Many things of one kind, drawn by a handful of calls: in detail where they are seen large, as
// boxes where they are small, and not at all out of sight.

import * as THREE from '/three/build/three.module.js';
import { Instances, Merged } from './copies.js';
import { drawsInSoftware } from './software.js';

export const FAR = 1, NEAR = 2;
const CHEAP = 60000; // vertices: a crowd of so few is always drawn in detail

export class Crowd {
  /** `count` things whose shapes reach `radius` around `centre` [m, in the thing's frame]. They
   *  are seen in detail from `detail` pixels a metre on. */
  constructor(group, count, { centre, radius }, detail) {
    Object.assign(this, { group, count, centre, radius, detail });
    this.base = new Float32Array(16 * count); // where each is
    this.tint = new Float32Array(3 * count);
    for (let i = 0; i < count; ++i) this.base[16 * i + 15] = 1; // of no size until placed
    this.layers = [];
    this.vertices = 0; // of all in detail
    this.stale = true;
  }

  /** Draws a geometry for each thing at a level; `place(i, array, at)` turns a thing's matrix there
   *  into that of a part that moves on it. */
  add(geometry, material, level, place = null) {
    const copies = new (drawsInSoftware() ? Merged : Instances)(geometry, material, this.count);
    this.group.add(copies.mesh);
    this.layers.push({ copies, level, place });
    if (level === NEAR) this.vertices += this.count * geometry.attributes.position.count;
  }

  put(i, matrix) {
    matrix.toArray(this.base, 16 * i);
    this.stale = true;
  }

  paint(i, colour) {
    colour.toArray(this.tint, 3 * i);
    this.stale = true;
  }

  /** Chooses how each is drawn, for a View; `moved`: it is another than before. */
  fill(view, moved) {
    if (!this.count || !(moved || this.stale)) return;
    this.stale = false;
    for (const { copies } of this.layers) copies.begin();
    for (let i = 0; i < this.count; ++i) {
      const wanted = this.levelOf(view, i);
      for (const { copies, level, place } of this.layers) {
        if (level === wanted) copies.add(this.base, this.tint, i, place);
      }
    }
    for (const { copies } of this.layers) copies.end();
  }

  levelOf(view, i) {
    const { base, centre: [cx, cy, cz] } = this, at = 16 * i;
    // Things stand upright, or nearly so.
    const x = base[at + 12] + base[at] * cx + base[at + 4] * cy;
    const y = base[at + 13] + base[at + 1] * cx + base[at + 5] * cy;
    const scale = view.scaleAt(x, y, base[at + 14] + cz, this.radius);
    if (scale === 0) return 0;
    return scale >= this.detail || this.vertices <= CHEAP ? NEAR : FAR;
  }
}

/** What a camera sees, and how large. */
export class View {
  constructor() {
    this.planes = new Float64Array(24);
    this.matrix = new THREE.Matrix4();
    this.frustum = new THREE.Frustum();
  }

  /** Updates the view for a camera and a picture of that height [px]. Returns whether it changed. */
  update(camera, height) {
    camera.updateMatrixWorld();
    const matrix = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    if (matrix.equals(this.matrix) && height === this.height) return false;
    Object.assign(this, { matrix, height });
    this.eye = camera.position.toArray();
    this.focal = height / 2 * camera.projectionMatrix.elements[5]; // [px]
    this.frustum.setFromMatrix(matrix).planes.forEach(({ normal, constant }, i) => (
      this.planes.set([normal.x, normal.y, normal.z, constant], 4 * i)));
    return true;
  }

  /** Pixels a metre of a sphere there [m]; 0: it is out of sight. */
  scaleAt(x, y, z, radius) {
    const { planes, eye } = this;
    for (let i = 0; i < 24; i += 4) {
      if (planes[i] * x + planes[i + 1] * y + planes[i + 2] * z + planes[i + 3] < -radius) return 0;
    }
    return this.focal / Math.max(0.1, Math.hypot(x - eye[0], y - eye[1], z - eye[2]));
  }
}
