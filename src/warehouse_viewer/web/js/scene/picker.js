// SPDX-License-Identifier: Apache-2.0
// What lies under the pointer.

import * as THREE from '/three/build/three.module.js';

const KINDS = ['robot', 'unit', 'item', 'scenery'];

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
  pick(x, y, kinds = KINDS) {
    const ray = this.aim(x, y);
    let best = null, nearest = Infinity;
    for (const kind of kinds) {
      this.each(kind, ray, (index, distance) => {
        if (distance < nearest) [best, nearest] = [{ kind, index }, distance];
      });
    }
    return best;
  }

  each(kind, ray, hit) {
    const base = this.actors.baseOf(kind);
    const middle = new THREE.Vector3(), inverse = new THREE.Matrix4();
    for (let index = 0; 16 * index < base.length; ++index) {
      const { centre, radius } = this.actors.boundsOf({ kind, index });
      const place = inverse.fromArray(base, 16 * index);
      if (ray.distanceSqToPoint(middle.set(...centre).applyMatrix4(place)) > radius ** 2) continue;
      const own = ray.clone().applyMatrix4(new THREE.Matrix4().getInverse(place));
      const boxes = this.actors.boxes[kind];
      for (const box of kind === 'scenery' ? boxes[index] : boxes) {
        const distance = enters(own.clone().applyMatrix4(box.inverse), box.half);
        if (distance < Infinity) hit(index, distance);
      }
    }
  }

  /** The nearest robot that is drawn within a distance [px], as {kind, index}, or null. */
  robotNear(x, y, reach) {
    const { shown, status } = this.actors.world;
    let best = null, nearest = reach;
    for (let index = 0; index < status.length; ++index) {
      const [px, py] = this.stage.pixelOf(shown[3 * index], shown[3 * index + 1], 0.2);
      const distance = Math.hypot(px - x, py - y);
      if (distance < nearest) [best, nearest] = [{ kind: 'robot', index }, distance];
    }
    return best;
  }

  /** [x, y] of the floor there, or null beyond its edge. */
  pointOnFloor(x, y) {
    const point = this.aim(x, y).intersectPlane(this.floor, new THREE.Vector3());
    const [x0, x1, y0, y1] = this.stage.bounds;
    const inside = point && point.x > x0 && point.x < x1 && point.y > y0 && point.y < y1;
    return inside ? [point.x, point.y] : null;
  }
}

/** Distance of a ray to a box of these half edges around the origin (Kay and Kajiya 1986), or
 *  Infinity. */
export function enters({ origin, direction }, half) {
  let near = 0, far = Infinity;
  ['x', 'y', 'z'].forEach((axis, i) => {
    const [from, along] = [origin[axis], direction[axis]];
    if (along === 0) {
      if (Math.abs(from) > half[i]) near = Infinity;
      return;
    }
    const ends = [(-half[i] - from) / along, (half[i] - from) / along];
    near = Math.max(near, Math.min(...ends));
    far = Math.min(far, Math.max(...ends));
  });
  return near <= far && near < Infinity ? near : Infinity;
}
