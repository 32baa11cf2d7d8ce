// SPDX-License-Identifier: Apache-2.0
// The numbers that are printed on storage units, where these are near enough to be read.

import * as THREE from '/three/build/three.module.js';

const MOST = 40; // units
const LEGIBLE = 70; // [px] a metre
const SIZE = [0.34, 0.13], TEXELS = [128, 48]; // of a plate [m], and of its picture
const GAP = 0.004; // from a unit's side [m]

export class Numbers {
  constructor(stage, world, actors) {
    Object.assign(this, { stage, world, actors, plates: [], pictures: new Map() });
    this.group = new THREE.Group();
    stage.scene.add(this.group);
  }

  set(isOn) {
    this.group.visible = isOn;
    this.renew();
  }

  /** All units are others now. */
  renew() {
    for (const { material } of this.plates) material.dispose();
    for (const picture of this.pictures.values()) picture.dispose();
    this.pictures.clear();
    this.group.remove(...this.plates);
    this.plates = [];
    this.geometry?.dispose();
    this.geometry = platesOf(this.actors.bounds.unit);
  }

  /** Before each picture: plates stand on the units that are seen largest. */
  draw(view) {
    const near = nearest(this.actors.units.base, view, this.actors.units.centre);
    near.forEach((unit, i) => {
      const plate = this.plates[i] ??= this.make();
      const map = this.pictureOf(unit);
      if (plate.material.map !== map) Object.assign(plate.material, { map, needsUpdate: true });
      plate.matrix.fromArray(this.actors.units.base, 16 * unit);
      plate.visible = true;
    });
    for (const plate of this.plates.slice(near.length)) plate.visible = false;
  }

  make() {
    const out = new THREE.Mesh(this.geometry, new THREE.MeshBasicMaterial());
    Object.assign(out, { matrixAutoUpdate: false, frustumCulled: false });
    this.group.add(out);
    return out;
  }

  pictureOf(unit) {
    if (!this.pictures.has(unit)) this.pictures.set(unit, printed(this.world.scene.units[unit].match(/\d+$/)?.[0] ?? ''));
    return this.pictures.get(unit);
  }
}

/** Indices of the units that are seen largest by a View, and large enough. */
export function nearest(base, view, [, , height]) {
  const scales = [];
  for (let unit = 0; 16 * unit < base.length; ++unit) {
    const at = 16 * unit;
    const scale = view.isParallel ? 0 : view.scaleAt(base[at + 12], base[at + 13], base[at + 14] + height, 0.5);
    if (scale >= LEGIBLE) scales.push([scale, unit]);
  }
  return scales.sort((a, b) => b[0] - a[0]).slice(0, MOST).map(([, unit]) => unit);
}

/** A plate on each side of a unit, beneath its top. */
function platesOf({ min, max }) {
  const [width, height] = SIZE, z = max[2] - 0.6 * height, out = { position: [], uv: [] };
  for (const turn of [0, 1, 2, 3]) {
    const [c, s] = [[1, 0], [0, 1], [-1, 0], [0, -1]][turn];
    const away = GAP + (turn % 2 ? (s > 0 ? max[0] : -min[0]) : (c > 0 ? -min[1] : max[1]));
    for (const [u, v] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]]) {
      const along = (u - 0.5) * width;
      out.position.push(c * along + s * away, s * along - c * away, z + (v - 0.5) * height);
      out.uv.push(u, v);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(out.position, 3));
  geometry.setAttribute('uv', new THREE.Float32BufferAttribute(out.uv, 2));
  return geometry;
}

/** A picture of a number in black on white. */
function printed(number) {
  const canvas = Object.assign(document.createElement('canvas'), { width: TEXELS[0], height: TEXELS[1] });
  const pen = canvas.getContext('2d');
  pen.fillStyle = '#f2f3f0';
  pen.fillRect(0, 0, ...TEXELS);
  Object.assign(pen, { fillStyle: '#1b1f24', font: `600 ${0.8 * TEXELS[1]}px Inter, sans-serif`, textAlign: 'center', textBaseline: 'middle' });
  pen.fillText(number, TEXELS[0] / 2, TEXELS[1] / 2 + 2, TEXELS[0] - 12);
  const out = new THREE.CanvasTexture(canvas);
  out.anisotropy = 4;
  return out;
}
