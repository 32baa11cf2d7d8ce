// SPDX-License-Identifier: Apache-2.0
// The hall around the warehouse: a floor of concrete, low walls along its edges, and fog where nothing is.

import * as THREE from '/three/build/three.module.js';
import { token } from '../base/dom.js';
import { behind } from '../scene/paint.js';

const SLAB = 4; // edge of a slab of concrete [m]
const TEXELS = 128; // of a slab, along an edge
const WALL = { height: 0.45, thick: 0.16 }; // [m]
const COLOURS = { dark: { wall: 0x39434f, ground: 0x0c0f13 }, light: { wall: 0xb4bcc6, ground: 0xd5dae1 } };
const FAR = 1500; // half edge of the ground [m]
const BELOW = -0.04; // the floor [m]

export class Ground {
  constructor(stage) {
    this.stage = stage;
    this.group = new THREE.Group();
    this.group.visible = false;
    stage.scene.add(this.group);
    this.fog = new THREE.Fog(0, 10, 100);
  }

  set(isOn) {
    this.isOn = isOn;
    this.group.visible = isOn;
    this.stage.scene.fog = null;
    this.renew();
  }

  /** The floor is another one. */
  renew() {
    const { floor, bounds } = this.stage;
    for (const mesh of this.group.children) mesh.geometry.dispose();
    this.group.remove(...this.group.children);
    this.concrete ??= concretePicture();
    const [x0, x1, y0, y1] = bounds;
    this.concrete.repeat.set((x1 - x0) / SLAB, (y1 - y0) / SLAB);
    floor.material.map = this.isOn ? this.concrete : null;
    floor.material.needsUpdate = true;
    if (!this.isOn) return;
    this.wall = new THREE.MeshLambertMaterial();
    this.ground = new THREE.MeshBasicMaterial(behind(4));
    this.addWalls(bounds);
    const below = new THREE.Mesh(new THREE.PlaneBufferGeometry(2 * FAR, 2 * FAR), this.ground);
    below.position.set((x0 + x1) / 2, (y0 + y1) / 2, BELOW);
    this.group.add(below);
    this.setTheme(document.documentElement.dataset.theme);
  }

  addWalls([x0, x1, y0, y1]) {
    const { height, thick } = WALL, [cx, cy] = [(x0 + x1) / 2, (y0 + y1) / 2];
    const across = x1 - x0 + 2 * thick, along = y1 - y0;
    for (const [x, y, width, depth] of [[cx, y0 - thick / 2, across, thick], [cx, y1 + thick / 2, across, thick],
      [x0 - thick / 2, cy, thick, along], [x1 + thick / 2, cy, thick, along]]) {
      const wall = new THREE.Mesh(new THREE.BoxBufferGeometry(width, depth, height), this.wall);
      wall.position.set(x, y, height / 2 + BELOW);
      wall.castShadow = true;
      this.group.add(wall);
    }
  }

  setTheme(theme) {
    if (!this.isOn) return;
    this.wall.color.set(new THREE.Color(COLOURS[theme].wall));
    this.ground.color.set(new THREE.Color(COLOURS[theme].ground));
    this.fog.color.set(token('cell-nothing'));
  }

  /** Fog begins beyond the floor, as the camera sees it; rays from straight above pass none. */
  follow() {
    const { camera, controls, bounds: [x0, x1, y0, y1], isAbove, scene } = this.stage;
    const reach = camera.position.distanceTo(controls.target) + Math.hypot(x1 - x0, y1 - y0);
    Object.assign(this.fog, { near: 0.8 * reach, far: 3.2 * reach });
    scene.fog = isAbove ? null : this.fog;
  }
}

/** A slab of concrete: grains and clouds, darker at its joints. It multiplies the floor's colour. */
function concretePicture() {
  const texels = new Uint8Array(4 * TEXELS * TEXELS), random = numbers(7);
  for (let y = 0; y < TEXELS; ++y) {
    for (let x = 0; x < TEXELS; ++x) {
      const cloud = 5 * Math.sin(2 * Math.PI * x / TEXELS + 1) * Math.cos(2 * Math.PI * y / TEXELS) + 4 * Math.sin(6 * Math.PI * (x + y) / TEXELS);
      const joint = Math.min(x, y) < 1 ? 34 : 0, grain = 12 * random();
      texels.set([...Array(3).fill(Math.max(0, Math.min(255, 243 + cloud - grain - joint))), 255], 4 * (y * TEXELS + x));
    }
  }
  const out = new THREE.DataTexture(texels, TEXELS, TEXELS, THREE.RGBAFormat);
  Object.assign(out, { wrapS: THREE.RepeatWrapping, wrapT: THREE.RepeatWrapping, magFilter: THREE.LinearFilter,
    minFilter: THREE.LinearMipMapLinearFilter, generateMipmaps: true, anisotropy: 8, needsUpdate: true });
  return out;
}

/** The same numbers in 0…1 for the same seed (a linear congruential generator). */
function numbers(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 4294967296;
  };
}
