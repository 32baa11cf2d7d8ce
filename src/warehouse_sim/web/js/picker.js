// SPDX-License-Identifier: Apache-2.0
// What lies under the pointer.

import * as THREE from '/three/build/three.module.js';

const REACH = { robot: 0.7, unit: 1.5, item: 0.25, scenery: 40 }; // of a sphere around each [m]
const HEIGHT = { robot: 0.2, unit: 0.9, item: 0.06, scenery: 0 }; // of its centre [m]

export class Picker {
  constructor(stage, actors) {
    Object.assign(this, { stage, actors });
    this.caster = new THREE.Raycaster();
    this.floor = new THREE.Plane(new THREE.Vector3(0, 0, 1), 0);
  }

  /** The ray through a point of the window [px]. */
  aim(x, y) {
    const pointer = new THREE.Vector2(2 * x / innerWidth - 1, 1 - 2 * y / innerHeight);
    this.caster.setFromCamera(pointer, this.stage.camera);
    return this.caster.ray;
  }

  /** {kind, index} of what is hit first, or null. */
  pick(x, y) {
    const ray = this.aim(x, y);
    let best = null, nearest = Infinity;
    for (const kind of Object.keys(REACH)) {
      const distance = (index, d) => {
        if (d < nearest) [best, nearest] = [{ kind, index }, d];
      };
      this.each(kind, ray, distance);
    }
    return best;
  }

  each(kind, ray, hit) {
    const base = this.actors.base?.[kind] ?? [];
    const centre = new THREE.Vector3(), inverse = new THREE.Matrix4();
    for (let i = 0; 16 * i < base.length; ++i) {
      centre.set(base[16 * i + 12], base[16 * i + 13], base[16 * i + 14] + HEIGHT[kind]);
      if (ray.distanceSqToPoint(centre) > REACH[kind] ** 2) continue;
      inverse.getInverse(new THREE.Matrix4().fromArray(base, 16 * i));
      const own = ray.clone().applyMatrix4(inverse);
      const boxes = this.actors.boxes[kind];
      for (const box of kind === 'scenery' ? boxes[i] : boxes) {
        const distance = enters(own.clone().applyMatrix4(box.inverse), box.half);
        if (distance < Infinity) hit(i, distance);
      }
    }
  }

  /** [x, y] of the floor there, or null beyond its edge. */
  pointOnFloor(x, y) {
    const point = this.aim(x, y).intersectPlane(this.floor, new THREE.Vector3());
    const [x0, x1, y0, y1] = this.stage.bounds;
    const inside = point && point.x > x0 && point.x < x1 && point.y > y0 && point.y < y1;
    return inside ? [point.x, point.y] : null;
  }
}

/** Distance to a box of these half edges around the origin (Kay and Kajiya 1986), or Infinity. */
function enters({ origin, direction }, half) {
  let near = 0, far = Infinity;
  ['x', 'y', 'z'].forEach((axis, i) => {
    const [from, along] = [origin[axis], direction[axis]];
    const ends = [(-half[i] - from) / along, (half[i] - from) / along];
    if (along === 0) {
      if (Math.abs(from) > half[i]) near = Infinity;
      return;
    }
    near = Math.max(near, Math.min(...ends));
    far = Math.min(far, Math.max(...ends));
  });
  return near <= far ? near : Infinity;
}
