// SPDX-License-Identifier: Apache-2.0
// What shows robots from afar and by night: a ring on the floor in the colour of what they do, which is seen
// beneath the unit that they carry, lamps, and the light of the lamps on the floor.

import * as THREE from '/three/build/three.module.js';
import { FAR, NEAR } from '../scene/crowd.js';
import { flatMaterial } from '../scene/shelves.js';

const RING = [0.47, 0.56]; // radii: a unit reaches 0.4 m to its sides [m]
const HEIGHT = 0.012; // over the floor [m]
const LAMP = [0.02, 0.09, 0.035]; // its edges [m]
const BEAM = [1.5, 0.9]; // of the light on the floor: how far ahead, how wide [m]
const OVER_SHADOWS = 1; // as three's renderOrder

export class Marks {
  /** `robots` as the actors have them. */
  constructor(robots, world) {
    Object.assign(this, { crowd: robots.crowd, world, layers: [] });
    const { crowd } = this;
    if (!crowd.layers.length) return;
    const { max } = robots.bounds;
    this.beam = beamMaterial();
    this.layers = [
      { geometry: tinted(new THREE.RingBufferGeometry(...RING, 40)), material: flatMaterial(), levels: NEAR | FAR,
        order: OVER_SHADOWS, place: (i, out, at) => (world.loadOf(i) < 0 ? vanish(out, at) : onFloor(i, out, at)) },
      { geometry: lamps(max), material: new THREE.MeshBasicMaterial({ color: 0xfff6d8 }), levels: NEAR, order: OVER_SHADOWS, place: null },
      { geometry: new THREE.PlaneBufferGeometry(...BEAM).translate(max[0] + BEAM[0] / 2, 0, 0), material: this.beam,
        levels: NEAR, order: OVER_SHADOWS, place: onFloor },
    ];
  }

  add() {
    this.crowd.layers.push(...this.layers);
    this.redraw();
  }

  remove() {
    const { crowd, layers } = this;
    for (const layer of layers) {
      const at = crowd.layers.indexOf(layer);
      if (at < 0) continue;
      crowd.layers.splice(at, 1);
      for (const { copies } of crowd.parts) {
        const [copy] = copies.splice(at, 1);
        if (copy) crowd.group.remove(copy.mesh);
      }
    }
    this.redraw();
  }

  setNight(isNight) {
    if (this.beam) this.beam.visible = isNight;
  }

  redraw() {
    for (const part of this.crowd.parts) part.stale = true;
  }
}

function onFloor(_, out, at) {
  out[at + 14] = HEIGHT;
}

/** Lays a thing of no size there. */
function vanish(out, at) {
  out.fill(0, at, at + 11);
}

/** A geometry that takes each robot's tint. */
function tinted(geometry) {
  const { count } = geometry.attributes.position;
  geometry.setAttribute('color', new THREE.Float32BufferAttribute(new Float32Array(3 * count).fill(1), 3));
  geometry.setAttribute('paint', new THREE.Float32BufferAttribute(new Float32Array(count).fill(1), 1));
  return geometry;
}

/** Two lamps at a robot's front, as one geometry. */
function lamps(max) {
  const z = 0.62 * max[2], points = [];
  for (const side of [-1, 1]) {
    const box = new THREE.BoxBufferGeometry(...LAMP).toNonIndexed().translate(max[0], side * 0.55 * max[1], z);
    points.push(...box.attributes.position.array);
  }
  const out = new THREE.BufferGeometry();
  out.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
  return out;
}

function beamMaterial() {
  const side = 32, texels = new Uint8Array(4 * side * side);
  for (let y = 0; y < side; ++y) {
    for (let x = 0; x < side; ++x) {
      const ahead = x / side, aside = Math.abs(2 * y / side - 1) / (0.35 + 0.65 * ahead);
      texels.set([255, 240, 200, 255 * 0.3 * (1 - ahead) * Math.max(0, 1 - aside * aside)], 4 * (y * side + x));
    }
  }
  const map = new THREE.DataTexture(texels, side, side, THREE.RGBAFormat);
  Object.assign(map, { magFilter: THREE.LinearFilter, minFilter: THREE.LinearFilter, needsUpdate: true });
  return new THREE.MeshBasicMaterial({ map, transparent: true, depthWrite: false });
}
