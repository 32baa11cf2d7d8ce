// SPDX-License-Identifier: Apache-2.0
// The cells on which something may be put, lit while one is chosen.

import * as THREE from '/three/build/three.module.js';

const SIZE = 0.8, HEIGHT = 0.015; // of a light, as a part of a cell; over the floor [m]
const COLOUR = 0x3fbf7f;

/** The cells [x, y] of a World on which nothing stands; `boundsOf(thing)` as the Actors have it. */
export function freeCells(world, boundsOf) {
  const { scene } = world, { grid, floor: [x0, x1, y0, y1] } = scene;
  const taken = new Set();
  const take = ([x, y], half) => {
    const [i0, i1, j0, j1] = [x - half, x + half, y - half, y + half].map((edge) => Math.round(edge / grid));
    for (let i = i0; i <= i1; ++i) for (let j = j0; j <= j1; ++j) taken.add(`${i} ${j}`);
  };
  const half = 0.45 * grid;
  scene.units.forEach((_, index) => take(world.placeOf({ kind: 'unit', index }), 0.1 * grid));
  scene.robots.forEach((_, index) => take(world.placeOf({ kind: 'robot', index }), half));
  scene.scenery.forEach((_, index) => takeBox(take, world.placeOf({ kind: 'scenery', index }), boundsOf({ kind: 'scenery', index }), grid));
  const out = [];
  for (let i = Math.ceil(x0 / grid); i * grid <= x1; ++i) {
    for (let j = Math.ceil(y0 / grid); j * grid <= y1; ++j) if (!taken.has(`${i} ${j}`)) out.push([i * grid, j * grid]);
  }
  return out;
}

/** Takes the cells over which a box lies that is turned. */
function takeBox(take, [x, y, , yaw], { min, max }, grid) {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)], step = grid / 2;
  for (let u = min[0]; u <= max[0] + step / 2; u += step) {
    for (let v = min[1]; v <= max[1] + step / 2; v += step) take([x + c * u - s * v, y + s * u + c * v], 0.1 * grid);
  }
}

export class FreeCells {
  constructor(stage, world, boundsOf) {
    Object.assign(this, { stage, world, boundsOf, lights: null });
  }

  /** Lights the free cells, or none. */
  show(isOn) {
    if (this.lights) {
      this.stage.scene.remove(this.lights);
      this.lights.geometry.dispose();
      this.lights = null;
    }
    if (isOn) this.light(freeCells(this.world, this.boundsOf));
    this.stage.invalidate();
  }

  light(cells) {
    const size = SIZE * this.world.scene.grid, matrix = new THREE.Matrix4();
    this.lights = new THREE.InstancedMesh(new THREE.PlaneBufferGeometry(size, size), new THREE.MeshBasicMaterial(
      { color: COLOUR, transparent: true, opacity: 0.35, depthWrite: false }), Math.max(1, cells.length));
    Object.assign(this.lights, { frustumCulled: false, renderOrder: 1, count: cells.length });
    cells.forEach(([x, y], i) => this.lights.setMatrixAt(i, matrix.makeTranslation(x, y, HEIGHT)));
    this.stage.scene.add(this.lights);
  }
}
