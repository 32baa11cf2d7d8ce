// SPDX-License-Identifier: Apache-2.0
// Where on the floor robots drive and where they wait, as colours.

import * as THREE from '/three/build/three.module.js';
import { tr } from '../language/texts.js';
import { STILL } from '../scene/backdrop.js';
import { Changes } from '../base/changes.js';
import { $, on, press } from '../base/dom.js';
import { STOPS, swatches, topOf } from '../base/heat_scale.js';
import { behind } from '../scene/paint.js';

const HEIGHT = 0.004; // over the floor, beneath robots [m]
const LEGEND = { traffic: tr`robots through a cell`, waiting: tr`seconds that robots waited in a cell` };
/** RGBA bytes of each value; nothing at all is transparent. */
export function coloursOf(values, top) {
  const out = new Uint8Array(4 * values.length);
  values.forEach((value, i) => {
    if (value <= 0) return;
    const at = Math.min(1, value / top) * (STOPS.length - 1);
    const low = Math.min(STOPS.length - 2, Math.floor(at));
    const mixed = STOPS[low].map((c, k) => c + (at - low) * (STOPS[low + 1][k] - c));
    out.set([...mixed, 120 + 110 * Math.min(1, value / top)], 4 * i);
  });
  return out;
}

export class HeatMap {
  constructor(stage) {
    Object.assign(this, { stage, kind: 'traffic', heat: null, changes: null, object: null });
    $('heat-scale').append(...swatches());
    for (const button of $('heat-kinds').children) {
      on(button, 'click', () => {
        this.kind = button.dataset.heat;
        this.draw();
      });
    }
  }

  /** Shows the heat map, or hides it. */
  want(isOn) {
    $('heat-panel').hidden = !isOn;
    this.changes?.close();
    this.changes = isOn ? new Changes(['heat'], {
      shift: ({ runs }) => this.take(runs ? this.heat : null, runs ? '' : tr`no shift is running`),
      heat: ({ heat }) => this.take(heat),
    }) : null;
    if (!isOn) this.take(null);
  }

  take(heat, text = '') {
    this.heat = heat;
    $('heat-text').textContent = text;
    this.draw();
  }

  draw() {
    for (const button of $('heat-kinds').children) press(button, button.dataset.heat === this.kind);
    if (this.object) {
      this.stage.scene.remove(this.object);
      for (const part of [this.object.geometry, this.object.material, this.object.material.map]) part.dispose();
      this.object = null;
    }
    if (this.heat) this.paint(this.heat);
    this.stage.renew();
  }

  paint({ x, y, spacing, width, seconds, ...heat }) {
    const values = heat[this.kind], rows = values.length / width, top = topOf(values);
    const map = new THREE.DataTexture(coloursOf(values, top), width, rows, THREE.RGBAFormat);
    map.needsUpdate = true;
    this.object = new THREE.Mesh(new THREE.PlaneBufferGeometry(width * spacing, rows * spacing),
      new THREE.MeshBasicMaterial({ map, transparent: true, depthWrite: false, ...behind(-1) }));
    this.object.position.set(x + (width - 1) * spacing / 2, y + (rows - 1) * spacing / 2, HEIGHT);
    this.object.layers.set(STILL);
    this.stage.scene.add(this.object);
    $('heat-text').textContent = tr`${LEGEND[this.kind]}, last ${Math.max(1, Math.round(seconds / 60))} min: 0 to ${Math.round(top)}`;
  }
}
