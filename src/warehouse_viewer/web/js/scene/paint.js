// SPDX-License-Identifier: Apache-2.0
// What is painted on the floor: storage places, lanes of stations, where no robot drives.

import * as THREE from '/three/build/three.module.js';
import { token } from '../base/dom.js';
import { STILL } from './backdrop.js';

const HEIGHT = -0.005; // between the floor and the borders of its cells [m]
const TIP = 0.16, WING = 0.2, BAR = 0.1; // of an arrowhead [m]

export class Paint {
  constructor(scene) {
    this.group = new THREE.Group();
    scene.add(this.group);
  }

  /** `paint`: by kind, x y and full extents of rectangles in a row [m]; `arrows`: x y yaw in a row
   *  [m, rad]. A mesh a kind. */
  set({ paint, arrows = [] }) {
    for (const mesh of this.group.children) mesh.geometry.dispose();
    this.group.remove(...this.group.children);
    for (const [kind, rows] of Object.entries(paint)) this.add(kind, quads(rows), 1);
    if (arrows.length) this.add('arrow', chevrons(arrows), 0);
    this.renew();
  }

  add(kind, geometry, depth) {
    const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial(behind(depth)));
    mesh.name = kind;
    mesh.layers.set(STILL);
    this.group.add(mesh);
  }

  /** Takes the colours of the theme. */
  renew() {
    for (const { name, material } of this.group.children) {
      material.color.set(token(`cell-${name}`) || token('cell-street'));
    }
  }
}

/** A material's offset behind what lies on it [steps of depth]: it does not shine through from afar. */
export function behind(steps) {
  return { polygonOffset: true, polygonOffsetFactor: steps, polygonOffsetUnits: steps };
}

/** Two triangles for each rectangle x, y, width, depth of a row of numbers. */
function quads(rows) {
  const points = [];
  for (let at = 0; at < rows.length; at += 4) {
    const [x, y, width, depth] = rows.slice(at, at + 4);
    for (const [i, j] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
      points.push(x + i * width / 2, y + j * depth / 2, HEIGHT);
    }
  }
  return ofQuads(points);
}

/** An open arrowhead for each x, y, yaw of a row of numbers: two slanted bars. */
export function chevrons(rows) {
  const points = [];
  for (let at = 0; at < rows.length; at += 3) {
    const [x, y, yaw] = rows.slice(at, at + 3), [c, s] = [Math.cos(yaw), Math.sin(yaw)];
    for (const side of [1, -1]) {
      const bar = [[TIP, 0], [TIP - WING, side * WING], [TIP - WING - BAR, side * WING], [TIP - BAR, 0]];
      for (const [along, across] of side > 0 ? bar : bar.reverse()) {
        points.push(x + c * along - s * across, y + s * along + c * across, HEIGHT);
      }
    }
  }
  return ofQuads(points);
}

/** Two triangles for every four points. */
function ofQuads(points) {
  const corners = [];
  for (let first = 0; first < points.length / 3; first += 4) {
    corners.push(...[0, 1, 2, 0, 2, 3].map((corner) => first + corner));
  }
  const out = new THREE.BufferGeometry();
  out.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
  out.setIndex(corners);
  return out;
}
