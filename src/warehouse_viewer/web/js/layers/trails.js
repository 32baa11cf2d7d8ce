// SPDX-License-Identifier: Apache-2.0
// Where robots have been.

import { Ribbons } from '../scene/ribbons.js';
import { COLOURS } from '../scene/robots.js';

const MOST_SEGMENTS = 12000, SEGMENT = 0.4; // of all trails; [m]
const HEIGHT = 0.02; // [m]

/** One ring of segments for all, the oldest overwritten. */
export class Trails {
  constructor(stage, world) {
    Object.assign(this, { stage, world, isOn: false });
    this.ribbons = new Ribbons({ opacity: 0.85, width: 3, most: MOST_SEGMENTS, isTinted: true, isOver: false });
    this.object = this.ribbons.object;
    stage.scene.add(this.object);
    this.clear();
  }

  /** Begins to draw trails, or forgets them. */
  want(isOn) {
    this.isOn = isOn;
    this.clear();
    this.stage.invalidate();
  }

  clear() {
    Object.assign(this, { next: 0, count: 0 });
    this.ends = new Map(); // of each robot's trail
    this.ribbons.show(0);
  }

  /** Adds the positions of these robots. */
  note(robots) {
    if (!this.isOn) return;
    for (const i of robots) {
      const [x, y] = this.world.pose.subarray(3 * i);
      const end = this.ends.get(i);
      const way = end ? Math.hypot(x - end[0], y - end[1]) : Infinity;
      if (way < SEGMENT) continue;
      this.ends.set(i, [x, y]);
      if (way < 3) this.draw(end, [x, y], COLOURS[this.world.activity[i]]);
    }
    this.ribbons.show(this.count);
  }

  draw(from, to, colour) {
    this.ribbons.ends.array.set([...from, HEIGHT, ...to, HEIGHT], 6 * this.next);
    colour.toArray(this.ribbons.tints.array, 3 * this.next);
    this.next = (this.next + 1) % MOST_SEGMENTS;
    this.count = Math.max(this.count, this.next);
  }
}
