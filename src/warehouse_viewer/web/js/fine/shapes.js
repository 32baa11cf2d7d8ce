// SPDX-License-Identifier: Apache-2.0
// Shapes that are seen near by: racks with beams and braces, boxes of many shades, robots with bevelled
// edges. Each takes the place of the plain geometry of its crowd, and gives it back.

import * as THREE from '/three/build/three.module.js';
import { NEAR } from '../scene/crowd.js';
import { materialOf, merge } from '../scene/looks.js';
import { boardsOf } from '../scene/shelves.js';

const DETAIL = 48; // [px] a metre, from which on units and items are drawn in detail
const BEVEL = 0.022; // of a robot's edges [m]
const THICK = 0.06; // edge from which on a box has bevels [m]
const BEAM = [0.028, 0.055], BRACE = 0.014; // of a rack: width and height; edge [m]
const STEEL = [0.8, 0.82, 0.85, 1], BOARD = [0.72, 0.66, 0.56, 1];
const ON_BOARD = 0.3; // how much of a unit's tint its boards have
const UPRIGHT = [0, 0, 0, 1];
// Cartons, totes and bags, muted as the pictures of units from afar.
const SHADES = [0xc9a678, 0xb89264, 0xd6ba92, 0xe3e1da, 0x8496ac, 0x98a898, 0xaa826e, 0xc4b49c].map((c) => new THREE.Color(c));

const isBoard = ({ size: [x, y, z] }) => z < 0.1 * Math.min(x, y);

export class Shapes {
  /** `actors` as the page draws them. */
  constructor({ robots, units, items, world }) {
    const { scene } = world, look = (index) => scene.looks[index] ?? [];
    this.crowds = [units, items];
    this.swaps = [];
    this.offer(robots.crowd, () => merge(look(scene.robot_look).filter(isBody), true, bevelled));
    if (boardsOf(look(scene.unit_look)).length) this.offer(units, () => rackOf(look(scene.unit_look)));
    this.offer(items, () => merge(look(scene.item_look), true), materialOf(true));
    for (let item = 0; item < scene.items.length; ++item) items.paint(item, SHADES[(item * 7 + (item >> 3)) % SHADES.length]);
  }

  /** Remembers what takes the place of a crowd's geometry near by, if it has one. */
  offer(crowd, make, material = null) {
    const at = crowd.layers.findIndex(({ levels, place, order }) => levels === NEAR && !place && order === 0);
    if (at < 0) return;
    const layer = crowd.layers[at];
    this.swaps.push({ crowd, at, fine: { geometry: make(), material }, plain: { geometry: layer.geometry, material: layer.material } });
  }

  add() {
    this.details = this.crowds.map((crowd) => crowd.detail);
    for (const crowd of this.crowds) crowd.detail = DETAIL;
    this.put('fine');
  }

  remove() {
    this.crowds.forEach((crowd, i) => { crowd.detail = this.details[i]; });
    this.put('plain');
  }

  put(which) {
    for (const { crowd, at, [which]: { geometry, material } } of this.swaps) {
      const layer = crowd.layers[at], { transparent, opacity, depthWrite } = layer.material; // as seen through by now
      layer.geometry = geometry;
      if (material) layer.material = Object.assign(material, { transparent, opacity, depthWrite });
      for (const part of crowd.parts) forget(part, at, crowd.group);
    }
    for (const { parts } of this.crowds) for (const part of parts) part.stale = true;
  }
}

/** Drops the copies of a layer: they are made with another geometry when they are drawn next. */
function forget(part, at, group) {
  const copies = part.copies[at];
  part.copies[at] = undefined;
  part.stale = true;
  if (!copies) return;
  group.remove(copies.mesh);
  copies.mesh.geometry.dispose();
}

/** Not a wheel or the tower, which move on a robot. */
const isBody = ({ name }) => !['left_wheel', 'right_wheel', 'tower'].includes(name);

/** A box whose edges are cut off; a thin one keeps them. */
function bevelled([x, y, z]) {
  if (Math.min(x, y, z) < THICK) return new THREE.BoxBufferGeometry(x, y, z);
  const [a, b] = [x / 2 - BEVEL, y / 2 - BEVEL], cut = BEVEL;
  const corners = [[a, -b + cut], [a, b - cut], [a - cut, b], [-a + cut, b], [-a, b - cut], [-a, -b + cut], [-a + cut, -b], [a - cut, -b]];
  const shape = new THREE.Shape(corners.map((corner) => new THREE.Vector2(...corner)));
  const depth = z - 2 * BEVEL;
  return new THREE.ExtrudeBufferGeometry(shape, { depth, bevelThickness: BEVEL, bevelSize: BEVEL, bevelSegments: 1 })
    .translate(0, 0, -depth / 2);
}

/** A storage unit as a rack: its shapes, beams beneath each board, and braces between the uprights. */
function rackOf(links) {
  const own = links.map((link) => ({ ...link, shapes: link.shapes.map((shape) => ({ ...shape, colour: isBoard(shape) ? BOARD : STEEL })) }));
  const boards = own.flatMap(({ shapes }) => shapes).filter(isBoard);
  const added = { name: 'beams', pose: [0, 0, 0, ...UPRIGHT], shapes: [...boards.flatMap(beamsOf), ...bracesOf(boards)] };
  return merge([...own, added], (shape) => (isBoard(shape) ? ON_BOARD : 1));
}

const rod = (at, turn, size) => ({ kind: 0, colour: STEEL, pose: [...at, ...turn], size });

/** Four beams along the edges of a board. */
function beamsOf({ pose: [x, y, z], size: [wide, deep, high] }) {
  const [thick, tall] = BEAM, below = z - high / 2 - tall / 2 + 0.01;
  return [-1, 1].flatMap((side) => [
    rod([x, y + side * (deep - thick) / 2, below], UPRIGHT, [wide, thick, tall]),
    rod([x + side * (wide - thick) / 2, y, below], UPRIGHT, [thick, deep, tall]),
  ]);
}

/** Braces from board to board, to and fro, on two sides. */
function bracesOf(boards) {
  const sorted = boards.toSorted((a, b) => a.pose[2] - b.pose[2]);
  return sorted.slice(1).flatMap(({ pose: [x, y, z], size: [wide, deep] }, i) => {
    const low = sorted[i].pose[2], rise = z - low, length = Math.hypot(deep, rise);
    const angle = (i % 2 ? 1 : -1) * Math.atan2(rise, deep);
    const turn = [Math.sin(angle / 2), 0, 0, Math.cos(angle / 2)];
    return [-1, 1].map((side) => rod([x + side * (wide / 2 - BRACE), y, (z + low) / 2], turn, [BRACE, length, BRACE]));
  });
}
