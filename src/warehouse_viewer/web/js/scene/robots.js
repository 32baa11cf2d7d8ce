// SPDX-License-Identifier: Apache-2.0
// The robots in the picture: chassis, wheels that roll, towers that lift, and an outline in the
// colour of what they do, which is seen through what they carry.

import * as THREE from '/three/build/three.module.js';
import { Crowd, FAR, NEAR, TINY } from './crowd.js';
import { boundsOf, hull, materialOf, matrixOf, merge } from './looks.js';
import { addShadows } from './shadows.js';
import { flatMaterial, speckGeometry } from './shelves.js';

// Colours by Activity, as design.css has them in the dark.
export const COLOURS = [0x8b97a7, 0x4f9cf9, 0x3fbf7f, 0xf2b036, 0xf0605a].map((c) => new THREE.Color(c));
const PAD = 0.49; // half edge of what is left of a robot's frame from afar [cells]
const LINE = 0.05, NOSE = 0.16; // of an outline: width, and of the arrow at its front [m]
const OVER_ALL = 2; // as three's renderOrder
const DETAIL = 22; // [px] a metre, from which on robots are drawn in detail
const MOVING = ['left_wheel', 'right_wheel', 'tower']; // links
const AT_REST = [0, 0, 0, 0, 0, 0, 1];

// Thousands of matrices a frame: these are reused.
const matrix = new THREE.Matrix4();
const local = new THREE.Matrix4();
const turn = new THREE.Matrix4();

export class Robots {
  /** The World's robots, all of the same look. */
  constructor(group, world, links) {
    const count = world.scene.robots.length, bounds = boundsOf(links);
    Object.assign(this, { world, bounds });
    this.crowd = new Crowd(group, count, bounds, DETAIL);
    this.rolled = new Float64Array(2 * count); // left and right wheel [rad]
    this.wheels = wheelsOf(links);
    if (!count || !links.some((link) => link.shapes.length)) return;
    addShadows(this.crowd, bounds, NEAR | FAR);
    this.crowd.add(merge(links.filter(({ name }) => !MOVING.includes(name)), true), materialOf(true), NEAR);
    this.crowd.add(hull(links, true, PAD * world.scene.grid), materialOf(true), FAR);
    this.crowd.add(speckGeometry(bounds), flatMaterial(), TINY);
    for (const [which, name] of MOVING.entries()) {
      const link = links.find((l) => l.name === name);
      if (link) this.addJoint(link, which);
    }
    this.crowd.add(outlineGeometry(bounds), outlineMaterial(), NEAR | FAR, null, OVER_ALL);
  }

  addJoint(link, which) {
    const rest = matrixOf(link.pose);
    const own = merge([{ ...link, pose: AT_REST }]);
    this.crowd.add(own, materialOf(), NEAR, (i, out, at) => {
      local.copy(rest);
      if (which < 2) local.multiply(turn.makeRotationY(this.rolled[2 * i + which]));
      else local.elements[14] += this.towerOf(i);
      local.premultiply(matrix.fromArray(this.crowd.base, 16 * i)).toArray(out, at);
    });
  }

  /** Height of a robot's tower [m]. */
  towerOf(i) {
    const load = this.world.loadOf(i);
    return load < 0 ? 0 : Math.max(0, this.world.unitPose[7 * load + 2]);
  }

  paint(robots) {
    for (const i of robots) this.crowd.paint(i, COLOURS[this.world.activity[i]]);
  }

  /** Puts a robot where it is drawn now. */
  put(i) {
    const [x, y, yaw] = this.world.shown.subarray(3 * i, 3 * i + 3);
    const old = this.crowd.base, at = 16 * i;
    if (old[at + 10]) { // it stood somewhere: its wheels roll from there
      const [left, right] = rolledBy([old[at + 12], old[at + 13], Math.atan2(old[at + 1], old[at])],
        [x, y, yaw], this.wheels);
      this.rolled[2 * i] += left;
      this.rolled[2 * i + 1] += right;
    }
    const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
    this.crowd.put(i, matrix.set(c, -s, 0, x, s, c, 0, y, 0, 0, 1, 0, 0, 0, 0, 1));
  }
}

/** {radius, track} of the wheels of a look [m]. */
export function wheelsOf(links) {
  const [left, right] = MOVING.map((name) => links.find((link) => link.name === name));
  if (!left?.shapes.length || !right) return { radius: Infinity, track: 0 };
  const radius = Math.max(...left.shapes.flatMap(({ size }) => size)) / 2;
  return { radius, track: left.pose[1] - right.pose[1] };
}

/** [left, right]: how far wheels turn [rad] from one pose [x, y, yaw] to the next. */
export function rolledBy([x0, y0, yaw0], [x, y, yaw], { radius, track }) {
  const ahead = Math.cos(yaw0) * (x - x0) + Math.sin(yaw0) * (y - y0);
  const apart = Math.sin(yaw - yaw0) * track / 2; // turns between two pictures are small
  return [(ahead - apart) / radius, (ahead + apart) / radius];
}

/** A robot's edges and which way it looks, at the height of its top. */
function outlineGeometry({ min, max }) {
  const corners = (gap) => [[min[0] - gap, min[1] - gap], [max[0] + gap, min[1] - gap],
    [max[0] + gap, max[1] + gap], [min[0] - gap, max[1] + gap]].map(([x, y]) => new THREE.Vector2(x, y));
  const ring = new THREE.Shape(corners(LINE / 2));
  ring.holes.push(new THREE.Path(corners(-LINE / 2).reverse()));
  const front = max[0] - 1.5 * LINE;
  const nose = new THREE.Shape([[front, 0], [front - NOSE, NOSE], [front - NOSE, -NOSE]]
    .map(([x, y]) => new THREE.Vector2(x, y)));
  const out = new THREE.ShapeBufferGeometry([ring, nose]).translate(0, 0, max[2]);
  for (const unused of ['normal', 'uv']) out.deleteAttribute(unused);
  return out;
}

/** Outlines in a light shade of each robot's tint, through whatever stands before it. */
function outlineMaterial() {
  const out = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.9, depthTest: false, side: THREE.DoubleSide });
  out.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace('#include <common>',
      '#include <common>\nattribute vec4 tint;\nvarying vec3 vTint;')
      .replace('#include <begin_vertex>', '#include <begin_vertex>\nvTint = mix(tint.rgb, vec3(1.0), 0.7);');
    shader.fragmentShader = shader.fragmentShader.replace('#include <common>',
      '#include <common>\nvarying vec3 vTint;')
      .replace('vec4 diffuseColor = vec4( diffuse, opacity );', 'vec4 diffuseColor = vec4(vTint, opacity);');
  };
  return out;
}
