// SPDX-License-Identifier: Apache-2.0
// What stands still is drawn once, where the processor draws: each picture begins with a copy of it, colours
// and depths, and has only to add what moves.

import * as THREE from '/three/build/three.module.js';

export const STILL = 1; // layer, as three has them, of what stands still; 0 is what moves
const EVERY = 500; // from one drawing to the next, for what came or went [ms]
const FIRST = -10; // as three's renderOrder

const VERTEX = 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }';
const FRAGMENT = `uniform sampler2D colours;
uniform highp sampler2D depths;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  gl_FragColor = texelFetch(colours, at, 0);
  gl_FragDepth = texelFetch(depths, at, 0).r;
}`;

/** When what stands still is drawn. */
export class Renewal {
  constructor() {
    this.isDue = true;
    this.last = -Infinity; // [ms]
  }

  /** It looks other, from now on. */
  ask() {
    this.isDue = true;
  }

  /** Whether the picture of that time [ms] draws it; `changed`: something came or went since. Many things
   *  do in a warehouse at work: they share a drawing. */
  settles(now, changed) {
    if (changed && now - this.last >= EVERY) this.isDue = true;
    return this.isDue;
  }

  /** The same, for the picture that is drawn now. */
  take(now) {
    const { isDue } = this;
    if (isDue) this.last = now;
    this.isDue = false;
    return isDue;
  }
}

export class Backdrop {
  /** Copies what stands still on the canvas of a renderer, by WebGL 2. */
  constructor(renderer, scene) {
    Object.assign(this, { renderer, scene, target: new THREE.WebGLRenderTarget(1, 1) });
    this.target.depthTexture = new THREE.DepthTexture(1, 1, THREE.FloatType);
    const uniforms = { colours: { value: this.target.texture }, depths: { value: this.target.depthTexture } };
    this.copy = new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), new THREE.ShaderMaterial({
      uniforms, vertexShader: VERTEX, fragmentShader: FRAGMENT, depthFunc: THREE.AlwaysDepth }));
    Object.assign(this.copy, { frustumCulled: false, renderOrder: FIRST });
    scene.add(this.copy);
  }

  /** Draws the scene; `isDue`: with what stands still. */
  draw(camera, isDue) {
    const { renderer, scene, target } = this, { width, height } = renderer.domElement;
    const isOther = target.width !== width || target.height !== height;
    if (isOther) target.setSize(width, height);
    if (isDue || isOther) this.render(target, camera, STILL);
    const { background } = scene;
    scene.background = null; // or it would be painted over what was copied
    this.render(null, camera, 0);
    scene.background = background;
  }

  render(target, camera, layer) {
    this.renderer.setRenderTarget(target);
    camera.layers.set(layer);
    this.renderer.render(this.scene, camera);
  }
}
