// SPDX-License-Identifier: Apache-2.0
// Lines and marks over the warehouse: the selection, the cell to go to, paths, scans.

import * as THREE from '/three/build/three.module.js';
import { Ribbons } from './ribbons.js';
import { within } from '../base/world.js';

const ACCENT = { dark: 0x6cacff, light: 0x1257c4 }; // as design.css has it
const FAR = 5; // drawn length of a ray without a return [m]
const RING = 0.1; // between a thing and its mark [m]

export class Overlays {
  constructor(stage, world) {
    Object.assign(this, { stage, world });
    this.ring = lines(squareCorners(1, 0.05));
    this.way = new Ribbons({ width: 4 });
    this.cell = throughAll(mesh(new THREE.PlaneBufferGeometry(0.94, 0.94), 0.35));
    this.goal = mesh(new THREE.RingBufferGeometry(0.22, 0.32, 24), 0.9);
    this.fan = mesh(new THREE.BufferGeometry(), 0.2);
    this.path = this.way.object;
    for (const object of [this.ring, this.cell, this.path, this.goal, this.fan]) {
      object.visible = false;
      object.frustumCulled = false;
      stage.scene.add(object);
    }
    this.setTheme(document.documentElement.dataset.theme);
  }

  setTheme(theme) {
    this.way.setColor(ACCENT[theme]);
    for (const object of [this.ring, this.cell, this.goal]) {
      object.material.color.set(ACCENT[theme]);
    }
    this.fan.material.color.set(0xd55e00);
    this.stage.invalidate();
  }

  /** Marks what is at [x, y, z, yaw] and reaches `half` metres around; null: nothing. */
  select(place, half = 0.5) {
    this.ring.visible = Boolean(place);
    if (place) {
      this.ring.position.set(place[0], place[1], place[2] + 0.02);
      this.ring.scale.setScalar(half + RING);
    }
    this.stage.invalidate();
  }

  /** Marks the cell at [x, y]; null: none. */
  point(cell) {
    this.cell.visible = Boolean(cell);
    if (cell) this.cell.position.set(...cell, 0.008);
    this.stage.invalidate();
  }

  /** Draws a path from [x, y] along points [[x, y], …], and a mark at `goal`; no points: no path. */
  showPath(from, points, goal = points[points.length - 1]) {
    this.goal.visible = Boolean(goal);
    if (goal) this.goal.position.set(...goal, 0.02);
    const corners = [from, ...points];
    this.way.set(points.flatMap((to, i) => [...corners[i], 0.03, ...to, 0.03]));
    this.stage.invalidate();
  }

  /** A scan {mount, angleMin, angleStep, ranges} from a robot at [x, y, z, yaw]; null: none. */
  showScan(scan, place) {
    this.fan.visible = Boolean(scan);
    if (scan) setPoints(this.fan, fanOf(scan, place));
    this.stage.invalidate();
  }
}

/** Corners of triangles, in world, that a scan's rays span; `mount` is [x, y, z, yaw] of the laser on
 *  the robot. */
export function fanOf({ mount, angleMin, angleStep, ranges }, place) {
  const [x, y, z, yaw] = within(place, mount);
  const ends = Array.from(ranges, (range, i) => {
    const angle = yaw + angleMin + i * angleStep;
    const far = Number.isFinite(range) ? range : range > 0 ? FAR : 0;
    return [x + far * Math.cos(angle), y + far * Math.sin(angle), z];
  });
  return ends.slice(1).flatMap((end, i) => [[x, y, z], ends[i], end]);
}

function lines(points) {
  const out = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial());
  setPoints(out, points);
  return out;
}

function mesh(geometry, opacity) {
  return new THREE.Mesh(geometry, new THREE.MeshBasicMaterial(
    { transparent: true, opacity, depthWrite: false, side: THREE.DoubleSide }));
}

/** Shown even where something stands in front. */
function throughAll(object) {
  object.material.depthTest = false;
  object.material.transparent = true;
  object.renderOrder = 2;
  return object;
}

function setPoints(object, points) {
  const position = new THREE.Float32BufferAttribute(points.flat(), 3);
  object.geometry.setAttribute('position', position);
}

/** Four corners of a square, drawn twice so that they show. */
function squareCorners(half, gap) {
  const out = [];
  for (const size of [half, half + gap]) {
    for (const [sx, sy] of [[1, 1], [1, -1], [-1, -1], [-1, 1]]) {
      out.push([sx * size, sy * size, 0], [sx * size, 0.5 * sy * size, 0]);
      out.push([sx * size, sy * size, 0], [0.5 * sx * size, sy * size, 0]);
    }
  }
  return out;
}
