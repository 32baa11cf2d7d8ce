// SPDX-License-Identifier: Apache-2.0
// Where robots have been.

import * as THREE from '/three/build/three.module.js';
import { COLOURS } from './robots.js';

const MOST_SEGMENTS = 20000, SEGMENT = 0.25; // of all trails; [m]

/** One ring of segments for all, the oldest overwritten. */
export class Trails {
  constructor(world) {
    this.world = world;
    this.positions = new THREE.BufferAttribute(new Float32Array(6 * MOST_SEGMENTS), 3);
    this.colours = new THREE.BufferAttribute(new Float32Array(6 * MOST_SEGMENTS), 3);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', this.positions);
    geometry.setAttribute('color', this.colours);
    const material = new THREE.LineBasicMaterial(
      { vertexColors: THREE.VertexColors, transparent: true, opacity: 0.8 });
    this.object = new THREE.LineSegments(geometry, material);
    this.object.frustumCulled = false;
    this.object.visible = false;
    this.clear();
  }

  clear() {
    this.next = 0;
    this.ends = new Map(); // of each robot's trail
    this.positions.array.fill(0);
    this.positions.needsUpdate = true;
  }

  /** Adds the positions of these robots. */
  note(robots) {
    if (!this.object.visible) return;
    for (const i of robots) {
      const [x, y] = this.world.pose.subarray(3 * i);
      const end = this.ends.get(i);
      const way = end ? Math.hypot(x - end[0], y - end[1]) : Infinity;
      if (way < SEGMENT) continue;
      this.ends.set(i, [x, y]);
      if (way < 3) this.draw(end, [x, y], COLOURS[this.world.activity[i]]);
    }
    this.positions.needsUpdate = this.colours.needsUpdate = true;
  }

  draw(from, to, colour) {
    const at = 6 * this.next;
    this.positions.array.set([...from, 0.02, ...to, 0.02], at);
    colour.toArray(this.colours.array, at);
    colour.toArray(this.colours.array, at + 3);
    this.next = (this.next + 1) % MOST_SEGMENTS;
  }
}
