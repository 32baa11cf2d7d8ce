// SPDX-License-Identifier: Apache-2.0
// Lines that can be seen from anywhere: as wide on the screen near by as from afar. WebGL draws
// lines one pixel wide and ignores another width.

import * as THREE from '/three/build/three.module.js';

const WORDS = 6; // of a segment: x y z of both ends

// Both ends in pixels; what lies behind the eye is cut off.
const VERTEX = `attribute vec3 from; attribute vec3 to; attribute vec3 tint;
uniform vec2 size; uniform float width; varying vec3 shade;
void main() {
  vec4 a = projectionMatrix * modelViewMatrix * vec4(from, 1.0), b = projectionMatrix * modelViewMatrix * vec4(to, 1.0);
  const float NEAR = 0.05;
  if (a.w < NEAR && b.w > NEAR) a = mix(a, b, (NEAR - a.w) / (b.w - a.w));
  else if (b.w < NEAR && a.w > NEAR) b = mix(b, a, (NEAR - b.w) / (a.w - b.w));
  vec2 way = (b.xy / b.w - a.xy / a.w) * size, along = length(way) > 0.0 ? normalize(way) : vec2(1.0, 0.0);
  gl_Position = position.x < 0.5 ? a : b;
  vec2 aside = along * (2.0 * position.x - 1.0) + vec2(-along.y, along.x) * position.y;
  gl_Position.xy += aside * width / size * gl_Position.w;
  shade = tint;
}`;
const FRAGMENT = `uniform vec3 color; uniform float opacity; varying vec3 shade;
void main() { gl_FragColor = vec4(color * shade, opacity); }`;

export class Ribbons {
  /** `width` [px]; `most` segments for a start; `isTinted`: each has a colour of its own. */
  constructor({ color = 0xffffff, opacity = 1, width = 3, most = 64, isTinted = false, isOver = true }) {
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0], 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const uniforms = { color: { value: new THREE.Color(color) }, opacity: { value: opacity },
      width: { value: width }, size: { value: new THREE.Vector2(1, 1) } };
    const material = new THREE.ShaderMaterial({ uniforms, vertexShader: VERTEX, fragmentShader: FRAGMENT,
      transparent: true, depthTest: !isOver, depthWrite: false, side: THREE.DoubleSide });
    this.object = new THREE.Mesh(geometry, material);
    Object.assign(this.object, { frustumCulled: false, renderOrder: 2, visible: false });
    this.object.onBeforeRender = () => uniforms.size.value.set(innerWidth, innerHeight);
    Object.assign(this, { uniforms, isTinted, count: 0 });
    this.room(most);
  }

  get visible() {
    return this.object.visible;
  }

  /** x y z of the ends of all segments, in a row. */
  get numbers() {
    return this.ends.array.subarray(0, WORDS * this.count);
  }

  setColor(color) {
    this.uniforms.color.value.set(color);
  }

  /** Makes room for that many segments; what was there is forgotten. */
  room(most) {
    const { geometry } = this.object;
    this.most = most;
    this.ends = new THREE.InstancedInterleavedBuffer(new Float32Array(WORDS * most), WORDS, 1);
    geometry.setAttribute('from', new THREE.InterleavedBufferAttribute(this.ends, 3, 0));
    geometry.setAttribute('to', new THREE.InterleavedBufferAttribute(this.ends, 3, 3));
    this.tints = new THREE.InstancedBufferAttribute(new Float32Array(3 * (this.isTinted ? most : 1)).fill(1), 3, false, this.isTinted ? 1 : most);
    geometry.setAttribute('tint', this.tints);
  }

  /** Shows segments, x y z of both ends of each in a row. */
  set(numbers) {
    const count = numbers.length / WORDS;
    if (count > this.most) this.room(2 * count);
    this.ends.array.set(numbers);
    this.show(count);
  }

  /** What the arrays have for the first `count` segments is shown. */
  show(count) {
    this.count = count;
    this.object.geometry.maxInstancedCount = count;
    this.ends.needsUpdate = true;
    if (this.isTinted) this.tints.needsUpdate = true;
    this.object.visible = count > 0;
  }
}
