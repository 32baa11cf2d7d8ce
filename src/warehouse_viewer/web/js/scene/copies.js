// SPDX-License-Identifier: Apache-2.0
// Copies of a geometry that are drawn by one call: as instances, or in one mesh.

import * as THREE from '/three/build/three.module.js';

const FIRST = 16; // copies for which a mesh has room at first
export const TINT = 4; // numbers of a copy: red green blue, each in 0…1, and which variant of its kind it is
const OWN = ['position', 'normal', 'tint']; // attributes in which copies differ

/** A graphics card draws many instances as fast as it draws one mesh. */
export class Instances {
  constructor(geometry, material) {
    const own = new THREE.BufferGeometry().copy(geometry);
    for (const [name, attribute] of Object.entries(geometry.attributes)) own.setAttribute(name, attribute); // shared
    this.mesh = new THREE.InstancedMesh(own, material, 0);
    this.mesh.frustumCulled = false;
    this.matrices = this.tints = new Float32Array();
    this.drawn = 0;
    this.grow(FIRST);
  }

  /** Makes room for a count of copies, and keeps those that are there. */
  grow(room) {
    const larger = (old, size) => {
      const out = new Float32Array(room * size);
      out.set(old);
      return out;
    };
    this.matrices = larger(this.matrices, 16);
    this.tints = larger(this.tints, TINT);
    this.mesh.instanceMatrix = new THREE.BufferAttribute(this.matrices, 16).setUsage(THREE.DynamicDrawUsage);
    this.tint = new THREE.InstancedBufferAttribute(this.tints, TINT).setUsage(THREE.DynamicDrawUsage);
    this.mesh.geometry.setAttribute('tint', this.tint);
    this.room = room;
  }

  begin() {
    this.drawn = 0;
  }

  /** Adds one with the matrix in `matrices` at 16 i and the tint in `tints` at 4 i; `place(i, array, at)`
   *  may change the matrix that was written there. */
  add(matrices, tints, i, place) {
    if (this.drawn === this.room) this.grow(2 * this.room);
    const out = this.matrices, to = 16 * this.drawn;
    for (let k = 0; k < 16; ++k) out[to + k] = matrices[16 * i + k];
    if (place) place(i, out, to);
    for (let k = 0; k < TINT; ++k) this.tints[TINT * this.drawn + k] = tints[TINT * i + k];
    this.drawn += 1;
  }

  end() {
    this.mesh.count = this.drawn;
    this.mesh.visible = this.drawn > 0;
    for (const attribute of [this.mesh.instanceMatrix, this.tint]) {
      attribute.updateRange.count = this.drawn * attribute.itemSize;
      attribute.needsUpdate = true;
    }
  }
}

/** A processor draws instances one by one, each at the price of a mesh: there the corners of all are put
 *  where they belong beforehand. The methods are those of Instances. */
export class Merged {
  constructor(geometry, material) {
    this.original = geometry;
    this.corners = geometry.attributes.position.count;
    this.attributes = { ...geometry.attributes,
      tint: new THREE.BufferAttribute(new Float32Array(TINT * this.corners), TINT) };
    this.matrix = new Float32Array(16);
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.room = 0;
    this.grow(FIRST);
  }

  /** Makes room for a count of copies, and keeps those that are there. */
  grow(room) {
    const { original, corners, attributes } = this;
    const geometry = new THREE.BufferGeometry();
    for (const [name, { array, itemSize }] of Object.entries(attributes)) {
      const all = new Float32Array(room * corners * itemSize);
      if (OWN.includes(name)) all.set(this.mesh.geometry.attributes[name]?.array ?? []);
      else for (let copy = 0; copy < room; ++copy) all.set(array, copy * array.length);
      geometry.setAttribute(name, new THREE.BufferAttribute(all, itemSize).setUsage(THREE.DynamicDrawUsage));
    }
    if (original.index) geometry.setIndex(new THREE.BufferAttribute(this.indices(room), 1));
    this.mesh.geometry.dispose();
    Object.assign(this.mesh, { geometry });
    this.room = room;
  }

  indices(room) {
    const { array } = this.original.index, out = new Uint32Array(room * array.length);
    for (let i = 0; i < out.length; ++i) {
      out[i] = array[i % array.length] + this.corners * Math.floor(i / array.length);
    }
    return out;
  }

  begin() {
    this.drawn = 0;
  }

  add(matrices, tints, i, place) {
    if (this.drawn === this.room) this.grow(2 * this.room);
    const { corners, matrix, attributes, mesh: { geometry } } = this;
    for (let k = 0; k < 16; ++k) matrix[k] = matrices[16 * i + k];
    if (place) place(i, matrix, 0);
    const first = 3 * corners * this.drawn;
    move(attributes.position.array, matrix, 1, geometry.attributes.position.array, first);
    if (attributes.normal) move(attributes.normal.array, matrix, 0, geometry.attributes.normal.array, first);
    const tint = geometry.attributes.tint.array, from = TINT * corners * this.drawn;
    for (let k = 0; k < TINT * corners; k += TINT) {
      for (let c = 0; c < TINT; ++c) tint[from + k + c] = tints[TINT * i + c];
    }
    this.drawn += 1;
  }

  end() {
    const { geometry } = this.mesh, each = this.original.index?.count ?? this.corners;
    this.mesh.visible = this.drawn > 0;
    geometry.setDrawRange(0, each * this.drawn);
    for (const name of OWN) {
      const attribute = geometry.attributes[name];
      if (!attribute || !this.drawn) continue;
      attribute.updateRange.count = this.corners * this.drawn * attribute.itemSize;
      attribute.needsUpdate = true;
    }
  }
}

/** Writes points x y z in a row as a matrix moves them, from `at` on; `shift` 0: directions. */
function move(points, m, shift, out, at) {
  for (let k = 0; k < points.length; k += 3) {
    const x = points[k], y = points[k + 1], z = points[k + 2];
    out[at + k] = m[0] * x + m[4] * y + m[8] * z + shift * m[12];
    out[at + k + 1] = m[1] * x + m[5] * y + m[9] * z + shift * m[13];
    out[at + k + 2] = m[2] * x + m[6] * y + m[10] * z + shift * m[14];
  }
}
