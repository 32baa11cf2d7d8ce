// SPDX-License-Identifier: Apache-2.0
// The slats that run along the top of conveyor belts.

import * as THREE from '/three/build/three.module.js';
import { Crowd, NEAR } from './crowd.js';
import { largestOf } from './looks.js';

const SLATS = 6, SPEED = 0.4; // a belt; [m/s]
const MARGIN = 0.04, SLAT = [0.05, 0.004]; // to the belt's edges; length and height [m]

const own = new THREE.Matrix4();
const model = new THREE.Matrix4();

export class Belts {
  /** `models` index the matrices of `base`; `links`: their look, whose largest shape is the belt. Slats
   *  are seen from `detail` pixels a metre on. */
  constructor(group, models, links, base, detail) {
    Object.assign(this, { models, base, way: 0 });
    const belt = largestOf(links ?? []);
    const [length, width, height] = belt?.size ?? [0, 0, 0];
    this.length = length - MARGIN;
    this.slats = new Crowd(group, belt ? SLATS * models.length : 0, { centre: [0, 0, 0], radius: width / 2 }, detail, 0);
    if (!belt) return;
    this.top = belt.matrix.elements[14] + height / 2 + SLAT[1] / 2;
    const slat = new THREE.BoxBufferGeometry(SLAT[0], width - MARGIN, SLAT[1]);
    this.slats.add(slat, new THREE.MeshLambertMaterial({ color: 0x3a3d42 }), NEAR);
  }

  /** Moves the belts' surfaces on by a duration [s]. */
  run(seconds) {
    if (!this.slats.count) return;
    this.way = (this.way + SPEED * seconds) % this.length;
    this.models.forEach((index, i) => {
      model.fromArray(this.base, 16 * index);
      for (let slat = 0; slat < SLATS; ++slat) {
        const x = (this.way + slat * this.length / SLATS) % this.length - this.length / 2;
        this.slats.put(SLATS * i + slat, own.makeTranslation(x, 0, this.top).premultiply(model));
      }
    });
  }
}
