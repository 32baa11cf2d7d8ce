// SPDX-License-Identifier: Apache-2.0
// Where a vehicle of VDA 5050 says that it will drive: its planned path, and the points of its
// intermediate path. The base and the horizon that were ordered are drawn by others, in another colour.

import * as THREE from '/three/build/three.module.js';
import { Ribbons } from '../scene/ribbons.js';

const COLOUR = 0xd14ec7, HEIGHT = 0.06; // over the lines of what was ordered [m]
const POINT = 0.12; // half side of a mark [m]

/** x y z of the ends of the segments through some points [x, y], in a row. */
export function segmentsOf(points) {
  return points.slice(1).flatMap(([x, y], i) => [...points[i], HEIGHT, x, y, HEIGHT]);
}

/** A cross at each point {x, y}. */
export function crossesOf(points) {
  return points.flatMap(({ x, y }) => [x - POINT, y - POINT, HEIGHT, x + POINT, y + POINT, HEIGHT,
    x - POINT, y + POINT, HEIGHT, x + POINT, y - POINT, HEIGHT]);
}

export class PlannedPath {
  constructor(stage) {
    this.stage = stage;
    this.line = new Ribbons({ color: new THREE.Color(COLOUR), width: 3 });
    stage.scene.add(this.line.object);
  }

  /** {planned_path, intermediate_path} of a robot; null: nothing. */
  show(planned) {
    if (planned === this.shown) return;
    this.shown = planned;
    this.line.set(planned ? [...segmentsOf(planned.planned_path), ...crossesOf(planned.intermediate_path)] : []);
    this.stage.invalidate();
  }
}
