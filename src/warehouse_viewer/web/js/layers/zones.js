// SPDX-License-Identifier: Apache-2.0
// The closed zones on the floor, each with its reason and the time that is left, and the one that is being
// drawn.

import * as THREE from '/three/build/three.module.js';
import { tr } from '../language/texts.js';
import { Ribbons } from '../scene/ribbons.js';
import { lasting } from '../base/time.js';

const COLOUR = 0xd55e00, DRAFT = 0x6cacff; // of what is closed, and of what is being drawn
const HEIGHT = 0.02, STRIPE = 0.5; // over the floor; between two stripes [m]
const INK = [213, 94, 0];

/** What a label says beside the reason: the time that is left, and how many robots are inside. */
export function noteOf({ until, inside }, now) {
  const left = until === null ? tr`until opened` : tr`${lasting(until - now)} left`;
  return inside.length ? tr`${left} · ${inside.length} inside` : left;
}

/** The four edges of a rectangle {x_min, …} as x y z of both ends of each, in a row. */
export function edgesOf({ x_min: x0, x_max: x1, y_min: y0, y_max: y1 }) {
  const corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
  return corners.flatMap((from, i) => [...from, HEIGHT, ...corners[(i + 1) % 4], HEIGHT]);
}

export class ZoneLayer {
  constructor(stage, world) {
    Object.assign(this, { stage, world, zones: [], planes: [], isHidden: false });
    this.border = new Ribbons({ color: COLOUR, width: 3 });
    this.draft = new Ribbons({ color: DRAFT, width: 4 });
    stage.scene.add(this.border.object, this.draft.object);
  }

  /** The zones of the server; they are hidden while the page shows the past. */
  take(zones) {
    this.zones = zones;
    this.draw();
  }

  hide(isHidden) {
    if (isHidden === this.isHidden) return;
    this.isHidden = isHidden;
    this.draw();
  }

  get shown() {
    return this.isHidden ? [] : this.zones;
  }

  draw() {
    for (const plane of this.planes) {
      this.stage.scene.remove(plane);
      plane.geometry.dispose();
    }
    this.planes = this.shown.map((zone) => this.plane(zone));
    this.border.set(this.shown.flatMap(edgesOf));
    this.stage.invalidate();
  }

  /** A rectangle with stripes, which do not depend on colour alone. */
  plane({ x_min: x0, x_max: x1, y_min: y0, y_max: y1 }) {
    this.material ??= new THREE.MeshBasicMaterial({ map: stripes(), transparent: true, depthWrite: false });
    const geometry = new THREE.PlaneBufferGeometry(x1 - x0, y1 - y0), uv = geometry.attributes.uv;
    for (let i = 0; i < uv.count; ++i) uv.setXY(i, uv.getX(i) * (x1 - x0) / STRIPE, uv.getY(i) * (y1 - y0) / STRIPE);
    const out = new THREE.Mesh(geometry, this.material);
    out.position.set((x0 + x1) / 2, (y0 + y1) / 2, HEIGHT - 0.005);
    out.renderOrder = 1;
    this.stage.scene.add(out);
    return out;
  }

  /** The rectangle that is being drawn; null: none. */
  sketch(rectangle) {
    this.draft.set(rectangle ? edgesOf(rectangle) : []);
    this.stage.invalidate();
  }

  /** [{text, kind, at, note}] for the Labels. */
  labels() {
    return this.shown.map((zone) => ({ text: zone.reason, kind: 'sign waiting', note: noteOf(zone, this.world.stamp),
      at: [(zone.x_min + zone.x_max) / 2, (zone.y_min + zone.y_max) / 2, HEIGHT] }));
  }
}

/** A texture of slanting stripes, of 16 by 16 texels. */
function stripes() {
  const size = 16, texels = new Uint8Array(4 * size * size);
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) texels.set([...INK, (x + y) % size < size / 2 ? 120 : 40], 4 * (y * size + x));
  }
  const out = new THREE.DataTexture(texels, size, size, THREE.RGBAFormat);
  Object.assign(out, { wrapS: THREE.RepeatWrapping, wrapT: THREE.RepeatWrapping, magFilter: THREE.LinearFilter, needsUpdate: true });
  return out;
}
