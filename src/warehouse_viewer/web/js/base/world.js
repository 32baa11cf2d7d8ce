// SPDX-License-Identifier: Apache-2.0
// What stands where: the server's latest update, and poses between two.

const SNAP = 3; // [m]; further, it was put there, it did not drive
const REACH = 0.3; // from a robot's centre to that of a unit which it may lift [m]


export class World {
  constructor() {
    this.stamp = 0; // simulated [s]
    this.interval = 100; // between two updates [ms, wall], measured
    this.arrived = 0;
    this.setScene({ revision: 0, robots: [], units: [], items: [], item_unit: [], item_pose: [],
      fallen_item: [], fallen_from: [],
      floor: [0, 0, 0, 0], grid: 1, looks: [], robot_look: -1, unit_look: -1, item_look: -1,
      scenery: [], scenery_look: [], paint: {}, stations: [] });
  }

  setScene(scene) {
    this.scene = scene;
    const robots = scene.robots.length;
    this.robotOf = new Map(scene.robots.map((id, i) => [id, i]));
    this.indexOf = new Map([
      ...(scene.stations ?? []).map(({ name }, i) => [name, { kind: 'station', index: i }]),
      ...scene.units.map((name, i) => [name, { kind: 'unit', index: i }]),
      ...scene.items.map((name, i) => [name, { kind: 'item', index: i }]),
      ...scene.scenery.map((name, i) => [name, { kind: 'scenery', index: i }]),
      ...scene.robots.map((id, i) => [`kiva${id}`, { kind: 'robot', index: i }]),
    ]);
    this.unitOf = new Map(scene.units.map((name, i) => [Number(name.match(/\d+$/)?.[0]), i]));
    this.itemsOf = scene.units.map(() => []);
    scene.item_unit.forEach((unit, item) => unit >= 0 && this.itemsOf[unit].push(item));
    // x y yaw of each robot: as received, where its drawing began, and as drawn now.
    this.pose = new Float64Array(3 * robots);
    this.from = new Float64Array(3 * robots);
    this.shown = new Float64Array(3 * robots);
    this.since = new Float64Array(robots).fill(-1); // when it was received [ms]; -1: never
    this.shelf = new Int32Array(robots);
    this.activity = new Uint8Array(robots);
    this.state = new Uint8Array(robots);
    this.charge = new Uint8Array(robots).fill(100); // [%]
    this.failures = new Uint8Array(robots); // bits of FAILURE
    this.loadLimit = new Float32Array(robots); // [m/s²], 0 = none
    this.moving = new Set();
    this.unitPose = new Float32Array(7 * scene.units.length);
    this.carrier = new Int32Array(scene.units.length);
    this.loosePose = new Float32Array(7 * scene.items.length);
    this.sceneryPose = new Float32Array(7 * scene.scenery.length);
  }

  /** Takes an update in. What changed: {robots, units, loose, scenery}, arrays of indices. */
  apply(update, now) {
    this.stamp = update.stamp;
    const gap = now - this.arrived;
    this.arrived = now;
    if (gap < 500) this.interval += 0.2 * (gap - this.interval);
    return {
      robots: this.takeRobots(update.robots, now),
      units: take(update.units, this.unitPose, this.carrier),
      loose: take(update.loose, this.loosePose),
      scenery: take(update.scenery, this.sceneryPose),
    };
  }

  takeRobots({ count, words, f32, i32, u8 }, now) {
    const changed = [];
    for (let row = 0, at = 0; row < count; ++row, at += words) {
      const i = i32[at];
      changed.push(i);
      this.shelf[i] = i32[at + 4];
      this.activity[i] = u8[4 * (at + 5)];
      this.state[i] = u8[4 * (at + 5) + 1];
      this.charge[i] = u8[4 * (at + 5) + 2];
      this.failures[i] = u8[4 * (at + 5) + 3];
      this.loadLimit[i] = f32[at + 6];
      this.aim(i, f32[at + 1], f32[at + 2], f32[at + 3], now);
    }
    return changed;
  }

  aim(i, x, y, yaw, now) {
    const [p, shown] = [this.pose, this.shown];
    const far = Math.hypot(x - shown[3 * i], y - shown[3 * i + 1]) > SNAP;
    p.set([x, y, yaw], 3 * i);
    if (this.since[i] < 0 || far) shown.set([x, y, yaw], 3 * i);
    this.from.set(shown.subarray(3 * i, 3 * i + 3), 3 * i);
    this.since[i] = now;
    this.moving.add(i);
  }

  /** Moves what is drawn; returns the indices of the robots that moved. */
  advance(now) {
    const moved = [...this.moving];
    const duration = 1.15 * Math.min(250, Math.max(50, this.interval));
    const { pose, from, shown } = this;
    for (const i of moved) {
      const part = Math.min(1, (now - this.since[i]) / duration);
      const at = 3 * i;
      shown[at] = from[at] + part * (pose[at] - from[at]);
      shown[at + 1] = from[at + 1] + part * (pose[at + 1] - from[at + 1]);
      shown[at + 2] = from[at + 2] + part * wrapped(pose[at + 2] - from[at + 2]);
      if (part === 1) this.moving.delete(i);
    }
    return moved;
  }

  /** Index of the carrier of a unit, -1 = none. */
  carrierOf(unit) {
    return this.carrier[unit] ? this.robotOf.get(this.carrier[unit]) ?? -1 : -1;
  }

  /** Index of the unit that a robot carries, -1 = none. */
  loadOf(robot) {
    return this.shelf[robot] ? this.unitOf.get(this.shelf[robot]) ?? -1 : -1;
  }

  /** [x, y, z, yaw] of anything, in world, as drawn. */
  placeOf({ kind, index }) {
    if (kind === 'robot') {
      const [x, y, yaw] = this.shown.subarray(3 * index, 3 * index + 3);
      return [x, y, 0, wrapped(yaw)];
    }
    if (kind === 'scenery') return planar(this.sceneryPose, index);
    if (kind === 'station') return this.placeOfStation(index);
    if (kind === 'item') return this.placeOfItem(index);
    const own = planar(this.unitPose, index);
    const carrier = this.carrierOf(index);
    return carrier < 0 ? own : within(this.placeOf({ kind: 'robot', index: carrier }), own);
  }

  placeOfStation(index) {
    const { x, y } = this.scene.stations[index];
    return [x, y, 0, 0];
  }

  placeOfItem(index) {
    const unit = this.scene.item_unit[index];
    if (unit < 0) return planar(this.loosePose, index);
    return within(this.placeOf({ kind: 'unit', index: unit }), planar(this.scene.item_pose, index));
  }

  nameOf({ kind, index }) {
    const { robots, units, items, scenery } = this.scene;
    if (kind === 'robot') return `kiva${robots[index]}`;
    return kind === 'station' ? this.scene.stations[index].name : { unit: units, item: items, scenery }[kind][index];
  }

  /** Index of the unit that stands within a robot's reach over [x, y], -1 = none. */
  unitAt([x, y]) {
    return this.scene.units.findIndex((_, unit) => !this.carrier[unit]
      && Math.hypot(this.unitPose[7 * unit] - x, this.unitPose[7 * unit + 1] - y) < REACH);
  }

  unitOver(robot) {
    return this.unitAt(this.pose.subarray(3 * robot, 3 * robot + 2));
  }
}

function take({ count, words, f32, i32 }, poses, carriers) {
  const changed = [];
  for (let row = 0, at = 0; row < count; ++row, at += words) {
    const i = i32[at];
    changed.push(i);
    poses.set(f32.subarray(at + 1, at + 8), 7 * i);
    if (carriers) carriers[i] = i32[at + 8];
  }
  return changed;
}

export function wrapped(angle) {
  return angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
}

function planar(poses, i) {
  const [x, y, z, qx, qy, qz, qw] = poses.slice(7 * i, 7 * i + 7);
  return [x, y, z, Math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))];
}

/** A place [x, y, z, yaw] given in a frame, in that frame's own. */
export function within([fx, fy, fz, fyaw], [x, y, z, yaw]) {
  const [c, s] = [Math.cos(fyaw), Math.sin(fyaw)];
  return [fx + c * x - s * y, fy + s * x + c * y, fz + z, wrapped(fyaw + yaw)];
}
