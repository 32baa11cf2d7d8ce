// SPDX-License-Identifier: Apache-2.0
// Where a coordinated fleet drives: what each robot has been released, what is planned beyond, and who
// waits for whom.

import { Ribbons } from '../scene/ribbons.js';

const WAY = 0x009e73, WAITS = 0xcc79a7; // as RViz has them
const HEIGHT = 0.04, TIE_HEIGHT = 0.3; // [m]

export class Ways {
  constructor(stage, world) {
    Object.assign(this, { stage, world, ways: new Map(), shown: [] });
    this.released = new Ribbons({ color: WAY, width: 4 });
    this.planned = new Ribbons({ color: WAY, opacity: 0.8, width: 3 });
    this.ties = new Ribbons({ color: WAITS, opacity: 0.9, width: 3 });
    for (const { object } of [this.released, this.planned, this.ties]) stage.scene.add(object);
  }

  /** `ways` as protocol.js reads them; `ids` of the robots whose ways are drawn, null: of all. */
  show(ways, ids) {
    this.ways = ways;
    this.shown = [...ways.keys()].filter((id) => this.world.robotOf.has(id) && (!ids || ids.includes(id)));
    const [released, planned] = [[], []];
    for (const id of this.shown) {
      const way = ways.get(id);
      addSolid(released, this.placeOf(id), way.released);
      addDashes(planned, way.released.subarray(-2), way.planned);
    }
    this.released.set(released);
    this.planned.set(planned);
    this.follow();
  }

  /** Lines between robots go with them. */
  follow() {
    const ties = [];
    for (const id of this.shown) {
      const { waitsFor } = this.ways.get(id);
      if (!this.world.robotOf.has(waitsFor)) continue;
      ties.push(...this.placeOf(id), TIE_HEIGHT, ...this.placeOf(waitsFor), TIE_HEIGHT);
    }
    this.ties.set(ties);
    this.stage.invalidate();
  }

  /** [x, y] of a robot as drawn. */
  placeOf(id) {
    const at = 3 * this.world.robotOf.get(id);
    return this.world.shown.subarray(at, at + 2);
  }
}

/** Adds segments from [x, y] on along points x y in a row; the first is where the robot was. */
export function addSolid(out, [x, y], points) {
  for (let at = 2; at < points.length; at += 2) {
    out.push(x, y, HEIGHT, points[at], points[at + 1], HEIGHT);
    [x, y] = points.subarray(at, at + 2);
  }
}

/** The same as dashes, one a cell. */
export function addDashes(out, [x, y], points) {
  for (let at = 0; at < points.length; at += 2) {
    const [toX, toY] = points.subarray(at, at + 2);
    const [dx, dy] = [toX - x, toY - y];
    if (dx || dy) out.push(x + 0.3 * dx, y + 0.3 * dy, HEIGHT, x + 0.7 * dx, y + 0.7 * dy, HEIGHT);
    [x, y] = [toX, toY];
  }
}
