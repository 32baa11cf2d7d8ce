// SPDX-License-Identifier: Apache-2.0
// The camera: everything in view, from above, or following a robot or a person.

import * as THREE from '/three/build/three.module.js';
import { seeAll } from './fit.js';

const NEAR = 7; // of one thing that is looked at [m]
const TILT = 0.75, ABOVE = 1e-4; // from the vertical [rad]
const HEIGHT = 0.6; // of what stands at the floor's edges [m]
const EDGE = 0.97; // of the free part of the picture

export class Navigator {
  constructor(stage) {
    this.stage = stage;
    this.followed = null; // a function that returns [x, y, z]
  }

  /** Shows everything as large as it fits; `above`: straight from above. */
  showAll(above = false) {
    const { camera, controls, bounds, margins: { left, right, top, bottom } } = this.stage;
    const half = Math.tan(camera.fov * Math.PI / 360) / innerHeight * EDGE;
    const free = [innerWidth - left - right, innerHeight - top - bottom].map((px) => Math.max(px, 100));
    const { position, target, way } = seeAll(bounds, HEIGHT, above ? ABOVE : TILT,
      free.map((px) => half * px));
    camera.position.set(...position);
    controls.target.set(...target);
    camera.near = Math.max(0.1, way / 500);
    camera.far = Math.max(500, 6 * way);
    camera.updateProjectionMatrix();
    controls.update();
    this.stage.invalidate();
  }

  /** Brings [x, y, z] to the middle, and nearer if it is far. */
  visit([x, y, z]) {
    const { camera, controls } = this.stage;
    const target = new THREE.Vector3(x, y, z);
    const offset = camera.position.clone().sub(controls.target);
    if (offset.length() > 3 * NEAR) offset.setLength(NEAR);
    controls.target.copy(target);
    camera.position.copy(target).add(offset);
    camera.near = 0.1;
    camera.updateProjectionMatrix();
    controls.update();
    this.stage.invalidate();
  }

  /** Goes along with what `place()` says, until told null. */
  follow(place) {
    this.followed = place;
    if (place) this.visit(place());
  }

  /** Before each picture. */
  advance() {
    if (!this.followed) return;
    const [x, y, z] = this.followed();
    const { camera, controls } = this.stage;
    const step = new THREE.Vector3(x, y, z).sub(controls.target);
    if (step.lengthSq() === 0) return;
    controls.target.add(step);
    camera.position.add(step);
    camera.lookAt(controls.target);
  }
}
