// SPDX-License-Identifier: Apache-2.0
// Many things of one kind, drawn by a handful of calls: in detail where they are seen large, as
// boxes where they are small, and not at all out of sight.

import * as THREE from '/three/build/three.module.js';
import { STILL } from './backdrop.js';
import { Instances, Merged, TINT } from './copies.js';
import { drawsInSoftware } from '../base/software.js';

// How large something is seen; a layer is drawn at one of them, or more (FAR | NEAR).
export const FAR = 1, NEAR = 2, TINY = 4;
const SMALL = 7; // [px] a metre, below which things are tiny
const CHEAP = 60000; // vertices up to which a crowd is always drawn in detail
const CHEAP_IN_SOFTWARE = 10000; // the same of what moves, where the processor draws
const TILE = 16; // edge of a square of the floor whose things are drawn together [m]
const MIDDLE = 1; // of what stands on the floor, above it [m]
const MOVING = 'moving'; // where things are that are under way, one by one

export class Crowd {
  /** `count` things whose shapes reach `radius` around `centre` [m, in the thing's frame]. They
   *  are seen in detail from `detail` pixels a metre on, or always, if in detail all have no more than
   *  `cheap` vertices. */
  constructor(group, count, { centre, radius }, detail, cheap = drawsInSoftware() ? CHEAP_IN_SOFTWARE : CHEAP) {
    Object.assign(this, { group, count, centre, radius, detail, cheap });
    this.base = new Float32Array(16 * count); // where each is
    this.tint = new Float32Array(TINT * count);
    for (let i = 0; i < count; ++i) this.base[16 * i + 15] = 1; // of no size until placed
    this.layers = [];
    this.vertices = 0; // of all in detail
    this.parts = [new Part(this, Array.from({ length: count }, (_, i) => i))];
  }

  /** Draws a geometry for each thing at some levels; `place(i, array, at)` turns a thing's matrix there
   *  into that of a part that moves on it; `order` as three's renderOrder. */
  add(geometry, material, levels, place = null, order = 0) {
    this.layers.push({ geometry, material, levels, place, order });
    if (levels === NEAR) this.vertices += this.count * geometry.attributes.position.count;
  }

  put(i, matrix) {
    matrix.toArray(this.base, 16 * i);
    this.partOf(i).stale = true;
  }

  /** Gives one a colour and, if its kind has some, a variant 0, 1, … */
  paint(i, { r, g, b }, variant = 0) {
    const { tint } = this, at = TINT * i;
    if (tint[at] === Math.fround(r) && tint[at + 1] === Math.fround(g) && tint[at + 2] === Math.fround(b)
      && tint[at + 3] === variant) return;
    [tint[at], tint[at + 1], tint[at + 2], tint[at + 3]] = [r, g, b, variant];
    this.partOf(i).stale = true;
  }

  get isCheap() {
    return this.vertices <= this.cheap;
  }

  partOf() {
    return this.parts[0];
  }

  /** Chooses how each is drawn, for a View; `moved`: it is another than before. */
  fill(view, moved) {
    for (const part of this.parts) part.fill(view, moved);
  }

  levelOf(view, i) {
    const { base, centre: [cx, cy, cz] } = this, at = 16 * i;
    // Things stand upright, or nearly so.
    const x = base[at + 12] + base[at] * cx + base[at + 4] * cy;
    const y = base[at + 13] + base[at + 1] * cx + base[at + 5] * cy;
    return this.levelAt(view.scaleAt(x, y, base[at + 14] + cz, this.radius));
  }

  /** How what is seen so large is drawn [px/m]; 0: it is out of sight. */
  levelAt(scale) {
    if (scale === 0) return 0;
    if (scale >= this.detail || this.isCheap) return NEAR;
    return scale >= SMALL ? FAR : TINY;
  }
}

/** Many things of which most stand still: those that stand on a square of the floor are one part of the
 *  backdrop, which is drawn as it was until one of them comes, goes or looks other. */
export class StandingCrowd extends Crowd {
  constructor(group, count, bounds, detail, cheap = CHEAP) {
    super(group, count, bounds, detail, cheap);
    this.places = Array(this.count).fill(MOVING);
    this.byPlace = new Map([[MOVING, this.parts[0]]]);
    this.halted = new Set(); // drawn as what moves until the backdrop takes them in
    this.layer = STILL;
  }

  partOf(i) {
    return this.byPlace.get(this.places[i]);
  }

  /** `moves`: it is under way. */
  put(i, matrix, moves = false) {
    super.put(i, matrix);
    if (moves) {
      this.halted.delete(i);
      this.bring(i, MOVING);
    } else this.halted.add(i);
  }

  /** Whether what stands is part of the backdrop. */
  setStill(isStill) {
    this.layer = isStill ? STILL : 0;
    for (const { copies, layer } of this.parts) for (const copy of copies) copy?.mesh.layers.set(layer);
  }

  /** Whether something came or went that the backdrop does not show yet. */
  get isUnsettled() {
    return this.halted.size > 0 || this.parts.some((part) => part instanceof Tile && part.stale);
  }

  /** `settles`: the backdrop takes in what changed. */
  fill(view, moved, settles) {
    if (settles) this.settle();
    for (const part of this.parts) if (settles || !(part instanceof Tile)) part.fill(view, moved);
  }

  settle() {
    for (const i of this.halted) {
      const [x, y] = [this.base[16 * i + 12], this.base[16 * i + 13]].map((at) => Math.floor(at / TILE));
      this.bring(i, `${x} ${y}`, x, y);
    }
    this.halted.clear();
  }

  bring(i, place, x, y) {
    if (place === this.places[i]) return;
    this.partOf(i).remove(i);
    this.places[i] = place;
    if (!this.byPlace.has(place)) {
      const part = new Tile(this, (x + 0.5) * TILE, (y + 0.5) * TILE);
      this.byPlace.set(place, part);
      this.parts.push(part);
    }
    this.partOf(i).members.add(i);
    this.partOf(i).stale = true;
  }
}

/** Things that are drawn together. */
class Part {
  constructor(crowd, members) {
    Object.assign(this, { crowd, members: new Set(members), stale: true, copies: [] });
  }

  get layer() {
    return 0;
  }

  remove(i) {
    this.members.delete(i);
    this.stale = true;
  }

  fill(view, moved) {
    if (!(moved || this.stale)) return;
    this.draw((i) => this.crowd.levelOf(view, i));
  }

  /** Draws each member at its level. */
  draw(levelOf) {
    const { crowd } = this, { layers } = crowd;
    this.stale = false;
    for (const copies of this.copies) copies?.begin();
    for (const i of this.members) {
      const level = levelOf(i);
      for (let layer = 0; layer < layers.length; ++layer) {
        if (layers[layer].levels & level) this.copiesOf(layer).add(crowd.base, crowd.tint, i, layers[layer].place);
      }
    }
    for (const copies of this.copies) copies?.end();
  }

  copiesOf(layer) {
    return this.copies[layer] ??= this.make(this.crowd.layers[layer]);
  }

  make({ geometry, material, order, casts = false }) {
    const copies = new (drawsInSoftware() ? Merged : Instances)(geometry, material);
    Object.assign(copies.mesh, { renderOrder: order, castShadow: casts });
    copies.mesh.layers.set(this.layer);
    this.crowd.group.add(copies.mesh);
    copies.begin();
    return copies;
  }
}

/** Things on a square of the floor, all of them drawn alike. */
class Tile extends Part {
  constructor(crowd, x, y) {
    super(crowd, []);
    Object.assign(this, { x, y, level: 0, reach: TILE * Math.SQRT1_2 + crowd.radius });
  }

  get layer() {
    return this.crowd.layer;
  }

  fill(view, moved) {
    if (!(moved || this.stale)) return;
    const { crowd, x, y, reach } = this;
    const level = crowd.levelAt(view.scaleOfSquare(x, y, TILE / 2, reach));
    for (const copies of this.copies) if (copies) copies.mesh.visible = level > 0 && copies.drawn > 0;
    if (level === 0 || (level === this.level && !this.stale)) return;
    this.level = level;
    this.draw(() => level);
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
    this.focal = height / 2 * camera.projectionMatrix.elements[5]; // [px]; of parallel rays [px/m]
    this.isParallel = Boolean(camera.isOrthographicCamera);
    this.frustum.setFromMatrix(matrix).planes.forEach(({ normal, constant }, i) => (
      this.planes.set([normal.x, normal.y, normal.z, constant], 4 * i)));
    return true;
  }

  /** Pixels a metre of a sphere there [m], or of its point that is `nearer` than its centre; 0: it is
   *  out of sight. */
  scaleAt(x, y, z, radius, nearer = 0) {
    const { planes, eye } = this;
    for (let i = 0; i < 24; i += 4) {
      if (planes[i] * x + planes[i + 1] * y + planes[i + 2] * z + planes[i + 3] < -radius) return 0;
    }
    if (this.isParallel) return this.focal;
    return this.focal / Math.max(0.1, Math.hypot(x - eye[0], y - eye[1], z - eye[2]) - nearer);
  }

  /** The same of the nearest point of a square of half an edge `half` around [x, y], whose things reach
   *  `radius` around its middle: storage units there, and what lies on them, are seen alike. */
  scaleOfSquare(x, y, half, radius) {
    const scale = this.scaleAt(x, y, MIDDLE, radius);
    if (this.isParallel || scale === 0) return scale;
    const beside = (at, from) => Math.max(0, Math.abs(from - at) - half);
    return this.focal / Math.max(0.1, Math.hypot(beside(x, this.eye[0]), beside(y, this.eye[1]), this.eye[2] - MIDDLE));
  }
}
