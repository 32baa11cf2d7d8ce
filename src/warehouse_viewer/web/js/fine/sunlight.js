// SPDX-License-Identifier: Apache-2.0
// The shadows that a light throws on the floor, around what is looked at.

import * as THREE from '/three/build/three.module.js';

const MAP = 2048; // of the shadow map [px]
const FROM = [-0.32, -0.45, 1]; // direction of the light
const AWAY = 120, LEAST = 10, MOST = 90; // of the light; half edges of the square that has shadows [m]
const HEIGHT = 0.002; // over the floor [m]
const FIRST = -2; // as three's renderOrder: beneath the baked shadows

export class Sunlight {
  constructor(stage) {
    this.stage = stage;
    const { sun } = stage;
    this.plain = sun.position.clone();
    sun.shadow.mapSize.set(MAP, MAP);
    sun.shadow.radius = 2.5;
    sun.shadow.bias = -0.0006;
    // Only shadows are painted on it: the floor beneath keeps its colours.
    this.sheet = new THREE.Mesh(new THREE.PlaneBufferGeometry(1, 1),
      new THREE.ShadowMaterial({ opacity: 0.3, depthWrite: false }));
    Object.assign(this.sheet, { receiveShadow: true, renderOrder: FIRST, visible: false });
    this.sheet.position.z = HEIGHT;
    stage.scene.add(this.sheet, sun.target);
  }

  set(isOn) {
    const { renderer, sun } = this.stage;
    renderer.shadowMap.enabled = isOn;
    renderer.shadowMap.type = THREE.PCFSoftShadowMap;
    sun.castShadow = this.sheet.visible = isOn;
    if (isOn) return;
    sun.position.copy(this.plain);
    sun.target.position.set(0, 0, 0);
    sun.target.updateMatrixWorld();
  }

  setShade(opacity = 0.3) {
    this.sheet.material.opacity = opacity;
  }

  /** Shadows lie around what the camera looks at, as far as it sees from there. */
  follow() {
    const { sun, camera, controls, isAbove } = this.stage, { target } = controls;
    const far = isAbove ? innerWidth / camera.zoom / 2 : camera.position.distanceTo(target);
    const half = Math.min(MOST, Math.max(LEAST, 0.9 * far));
    // Steps of whole texels, so that edges don't swim while the camera moves.
    const texel = 2 * half / MAP, snap = (value) => Math.round(value / texel / 32) * texel * 32;
    const [x, y] = [snap(target.x), snap(target.y)];
    sun.target.position.set(x, y, 0);
    sun.position.set(x + FROM[0] * AWAY, y + FROM[1] * AWAY, FROM[2] * AWAY);
    sun.target.updateMatrixWorld();
    this.sheet.position.set(x, y, HEIGHT);
    this.sheet.scale.set(2 * half, 2 * half, 1);
    const { camera: eye } = sun.shadow;
    if (eye.right === half) return;
    Object.assign(eye, { left: -half, right: half, bottom: -half, top: half, near: 1, far: 2 * AWAY });
    eye.updateProjectionMatrix();
  }
}
