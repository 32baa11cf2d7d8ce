// SPDX-License-Identifier: Apache-2.0
// Where the camera is: see all, from above, along with somebody.

import * as THREE from '/three/build/three.module.js';

const NEAR = 7; // of one thing that is looked at [m]

export class Navigator {
  constructor(stage) {
    this.stage = stage;
    this.followed = null; // a function that returns [x, y, z]
  }

  /** Everything in sight; `above`: straight from above, north up. */
  see(above = false) {
    const { camera, bounds: [x0, x1, y0, y1] } = this.stage;
    const centre = new THREE.Vector3((x0 + x1) / 2, (y0 + y1) / 2, 0);
    const [width, height] = this.room();
    const tilt = above ? 1e-4 : 0.85; // from the vertical [rad]
    const half = Math.tan(camera.fov * Math.PI / 360);
    const across = (x1 - x0) / (2 * half * camera.aspect * width);
    const along = (y1 - y0) * (above ? 1 : Math.cos(tilt)) / (2 * half * height);
    // Seen at a slant, the near edge is wider than the middle.
    const distance = (above ? 1.05 : 1.18) * Math.max(across, along) + 1;
    this.look(centre, distance, tilt);
  }

  /** The share of the window's width and height that no panel covers. */
  room() {
    return innerWidth > 760 ? [1 - 2 * 280 / innerWidth, 1 - 240 / innerHeight] : [0.95, 0.8];
  }

  look(target, distance, tilt) {
    const { camera, controls } = this.stage;
    controls.target.copy(target);
    const offset = new THREE.Vector3(0, -Math.sin(tilt), Math.cos(tilt));
    camera.position.copy(target).addScaledVector(offset, distance);
    camera.far = Math.max(500, 6 * distance);
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
