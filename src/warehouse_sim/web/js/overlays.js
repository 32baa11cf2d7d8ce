// SPDX-License-Identifier: Apache-2.0
// Lines and marks over the warehouse: the selection, the cell to go to, paths, scans, trails.

import * as THREE from '/three/build/three.module.js';
import { STATUS_COLOURS } from './actors.js';

const ACCENT = { dark: 0x56b4e9, light: 0x0072b2 };
const LASER = { ahead: 0.38, height: 0.2 }; // on the chassis [m], as in worlds/models/kiva
const MOST_SEGMENTS = 20000, SEGMENT = 0.25; // of trails; [m]

export class Overlays {
  constructor(stage, world) {
    Object.assign(this, { stage, world });
    this.ring = lines(squareCorners(0.55, 0.03));
    this.cell = mesh(new THREE.PlaneBufferGeometry(0.94, 0.94), 0.35);
    this.path = lines([]);
    this.goal = mesh(new THREE.RingBufferGeometry(0.22, 0.32, 24), 0.9);
    this.fan = mesh(new THREE.BufferGeometry(), 0.2);
    this.trails = new Trails(world);
    for (const object of [this.ring, this.cell, this.path, this.goal, this.fan]) {
      object.visible = false;
      object.frustumCulled = false;
      stage.scene.add(object);
    }
    stage.scene.add(this.trails.object);
    this.setTheme(document.documentElement.dataset.theme);
  }

  setTheme(theme) {
    for (const object of [this.ring, this.cell, this.path, this.goal]) {
      object.material.color.set(ACCENT[theme]);
    }
    this.fan.material.color.set(0xd55e00);
    this.stage.invalidate();
  }

  /** Marks what is at [x, y, z, yaw]; null: nothing. */
  select(place, radius = 1) {
    this.ring.visible = Boolean(place);
    if (place) {
      this.ring.position.set(place[0], place[1], place[2] + 0.02);
      this.ring.scale.setScalar(radius);
    }
    this.stage.invalidate();
  }

  /** Marks the cell at [x, y]; null: none. */
  point(cell) {
    this.cell.visible = Boolean(cell);
    if (cell) this.cell.position.set(...cell, 0.008);
    this.stage.invalidate();
  }

  /** From [x, y] along points [[x, y], …]; no points: no path. */
  showPath(from, points) {
    this.path.visible = this.goal.visible = points.length > 0;
    if (points.length) {
      const corners = [from, ...points];
      const segments = corners.slice(1).flatMap((to, i) => [[...corners[i], 0.03], [...to, 0.03]]);
      setPoints(this.path, segments);
      this.goal.position.set(...points[points.length - 1], 0.02);
    }
    this.stage.invalidate();
  }

  /** A scan {angleMin, angleStep, ranges} from a robot at [x, y, z, yaw]; null: none. */
  showScan(scan, place) {
    this.fan.visible = Boolean(scan);
    if (scan) setPoints(this.fan, fanOf(scan, place));
    this.stage.invalidate();
  }
}

function fanOf({ angleMin, angleStep, ranges }, [x, y, , yaw]) {
  const from = [x + LASER.ahead * Math.cos(yaw), y + LASER.ahead * Math.sin(yaw), LASER.height];
  const ends = [...ranges].map((range, i) => {
    const angle = yaw + angleMin + i * angleStep;
    const far = Number.isFinite(range) ? range : range > 0 ? 5 : 0;
    return [from[0] + far * Math.cos(angle), from[1] + far * Math.sin(angle), LASER.height];
  });
  return ends.slice(1).flatMap((end, i) => [from, ends[i], end]);
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

/** Where robots have been: one ring of segments for all, the oldest overwritten. */
class Trails {
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

  /** Takes in where these robots are. */
  note(robots) {
    if (!this.object.visible) return;
    for (const i of robots) {
      const [x, y] = this.world.pose.subarray(3 * i);
      const end = this.ends.get(i);
      const way = end ? Math.hypot(x - end[0], y - end[1]) : Infinity;
      if (way < SEGMENT) continue;
      this.ends.set(i, [x, y]);
      if (way < 3) this.draw(end, [x, y], STATUS_COLOURS[this.world.status[i]]);
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
