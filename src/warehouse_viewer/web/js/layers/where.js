// SPDX-License-Identifier: Apache-2.0
// Where the pieces of a SKU are: the storage units that hold some light up.

import * as THREE from '/three/build/three.module.js';
import { get } from '../base/api.js';
import { Changes } from '../base/changes.js';
import { tr } from '../language/texts.js';

const MOST = 1000; // bins
const SIZE = [0.9, 0.9, 1.95]; // of the light around a unit [m]
const COLOUR = 0x009e73;

/** The SKU in what a person types: 'where is sku-17?' is 'sku-17'; '' if there is no SKU in it. */
export function skuIn(text) {
  return text.trim().replace(/^where\s+(is|are)\s+/i, '').replace(/\s*\?$/, '');
}

/** Pieces by the number of the storage unit on which they lie, the most first, of places by item. */
export function piecesByUnit(places, sku) {
  const out = new Map();
  for (const place of places.values()) {
    if (place.sku !== sku || !place.quantity) continue;
    out.set(place.shelf_id, (out.get(place.shelf_id) ?? 0) + place.quantity);
  }
  return new Map([...out].sort((a, b) => b[1] - a[1] || a[0] - b[0]));
}

export class Where {
  /** `show(sku, units)` gets the pieces by unit whenever they change, `fail(text)` the reason why
   *  they are unknown; without a stage nothing is lit. */
  constructor(stage, world, show, fail) {
    Object.assign(this, { stage, world, show, fail, sku: '', units: new Map(), places: new Map() });
    if (stage) this.lights = this.make(0);
  }

  /** Looks for a SKU; '': for none. */
  async ask(sku) {
    if (sku === this.sku) {
      if (this.isKnown) this.emit();
      return;
    }
    Object.assign(this, { sku, isKnown: false });
    this.changes?.close();
    this.changes = null;
    this.places = new Map();
    if (sku) {
      const answer = await get(`/stock?limit=${MOST}&sku=${encodeURIComponent(sku)}`).catch((error) => error);
      if (sku !== this.sku) return; // another one was requested since
      if (answer instanceof Error) {
        this.sku = '';
        this.fail(tr`where is ${sku}? ${answer.message}`);
        return;
      }
      this.take(answer.places);
      if (answer.places.length) this.follow();
    }
    this.isKnown = true;
    this.emit();
  }

  /** Shows from now on what changes, too. */
  follow() {
    const { sku } = this;
    this.changes = new Changes(['stock'], { stock: ({ stock, missed }) => {
      if (missed) {
        this.sku = null;
        this.ask(sku);
        return;
      }
      if (!stock.some((place) => place.sku === sku || this.places.has(place.item))) return;
      this.take(stock.filter((place) => place.sku === sku || this.places.has(place.item)));
      this.emit();
    } });
  }

  take(places) {
    for (const place of places) this.places.set(place.item, place);
  }

  emit() {
    this.units = piecesByUnit(this.places, this.sku);
    this.show(this.sku, this.units);
    if (!this.stage) return;
    this.stage.scene.remove(this.lights);
    this.lights = this.make(this.units.size);
    this.stage.invalidate();
  }

  make(count) {
    const out = new THREE.InstancedMesh(new THREE.BoxBufferGeometry(...SIZE), new THREE.MeshBasicMaterial(
      { color: COLOUR, transparent: true, opacity: 0.45, depthTest: false }), Math.max(1, count));
    Object.assign(out, { frustumCulled: false, renderOrder: 3, count });
    this.stage.scene.add(out);
    return out;
  }

  /** [{text, kind, at}] of the lit units, and the lights over them; before each picture. */
  draw() {
    const labels = [], matrix = new THREE.Matrix4();
    let i = 0;
    for (const [number, pieces] of this.units) {
      const index = this.world.unitOf.get(number);
      if (index === undefined) continue;
      const [x, y, z, yaw] = this.world.placeOf({ kind: 'unit', index });
      matrix.makeRotationZ(yaw).setPosition(x, y, z + SIZE[2] / 2);
      this.lights.setMatrixAt(i, matrix);
      labels.push({ text: String(pieces), kind: 'pieces', at: [x, y, z + SIZE[2]] });
      i += 1;
    }
    this.lights.count = i;
    this.lights.instanceMatrix.needsUpdate = true;
    return labels;
  }
}
