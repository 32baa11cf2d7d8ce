// SPDX-License-Identifier: Apache-2.0
// The camera: everything in view, from above, flying to a thing, or following a robot or a person.

import * as THREE from '/three/build/three.module.js';
import { scaleFor, seeAll } from './fit.js';

const NEAR = 7, CLOSE = 60; // distance [m] and scale [px/m] at which one thing is looked at
const TILT = 0.75; // from the vertical [rad]
const ABOVE = 500; // where parallel rays begin [m]
const HEIGHT = 0.6; // of what stands at the floor's edges [m]
const EDGE = 0.97; // of the free part of the picture
const FLIGHT = 700; // [ms]
const STILL = matchMedia('(prefers-reduced-motion: reduce)');

export class Navigator {
  constructor(stage) {
    this.stage = stage;
    this.followed = null; // a function that returns [x, y, z]
    this.flight = null; // {from, to, since}, of what a camera has
    stage.controls.addEventListener('start', () => { this.flight = null; });
  }

  /** Shows everything as large as it fits; `above`: straight from above, turned the same way. */
  showAll(above = false) {
    const { stage } = this, { bounds, margins: { left, right, top, bottom } } = stage;
    const free = [innerWidth - left - right, innerHeight - top - bottom].map((px) => EDGE * Math.max(px, 100));
    const half = Math.tan(stage.slanted.fov * Math.PI / 360) / innerHeight;
    const { position, target, way, heading } = seeAll(bounds, HEIGHT, TILT, free.map((px) => half * px));
    this.flight = null;
    stage.lookFromAbove(above);
    if (above) this.lookDown(heading, free);
    else this.take({ position, target });
    Object.assign(stage.slanted, { near: Math.max(0.1, way / 500), far: Math.max(500, 6 * way) });
    stage.slanted.updateProjectionMatrix();
  }

  /** All of the floor from above, what lies towards `heading` at the top. */
  lookDown(heading, free) {
    const [x0, x1, y0, y1] = this.stage.bounds, middle = [(x0 + x1) / 2, (y0 + y1) / 2];
    const [c, s] = [Math.cos(heading), Math.sin(heading)].map((part) => ABOVE * 1e-5 * part);
    this.take({ position: [middle[0] - c, middle[1] - s, ABOVE], target: [...middle, 0],
      zoom: scaleFor(this.stage.bounds, heading, free) });
  }

  /** Where the camera is and what it looks at; `zoom` from above, else 0. */
  get view() {
    const { camera, controls, isAbove } = this.stage;
    return { position: camera.position.toArray(), target: controls.target.toArray(), zoom: isAbove ? camera.zoom : 0 };
  }

  /** Looks from a view of before. */
  restore(view) {
    this.showAll(Boolean(view.zoom)); // its near and far
    if (!view.zoom) this.stage.camera.near = 0.1;
    this.take(view);
  }

  take({ position, target, zoom }) {
    const { camera, controls } = this.stage;
    camera.position.set(...position);
    controls.target.set(...target);
    if (zoom) camera.zoom = zoom;
    camera.updateProjectionMatrix();
    controls.update();
    camera.updateMatrixWorld(); // for who asks before the next picture where something is
    this.stage.invalidate();
  }

  /** Brings [x, y, z] to the middle, and nearer if it is far; `fly`: on a way that the eye can follow. */
  visit([x, y, z], fly = false) {
    const { camera, controls, isAbove } = this.stage;
    const target = new THREE.Vector3(x, y, z);
    const offset = camera.position.clone().sub(controls.target);
    if (!isAbove && offset.length() > 3 * NEAR) offset.setLength(NEAR);
    const to = { position: target.clone().add(offset).toArray(), target: target.toArray(),
      zoom: isAbove && Math.max(camera.zoom, CLOSE) };
    if (!isAbove) camera.near = 0.1;
    if (!fly || STILL.matches) {
      this.take(to);
      return;
    }
    const from = { position: camera.position.toArray(), target: controls.target.toArray(), zoom: camera.zoom };
    this.flight = { from, to, since: performance.now() };
    this.stage.invalidate();
  }

  /** Moves the picture to the side by pixels, as far as that is at [x, y, z]. */
  slide(pixels, [x, y, z]) {
    const { stage } = this, { camera, controls } = stage;
    const right = new THREE.Vector3(1, 0, 0).applyQuaternion(camera.quaternion);
    const metre = stage.pixelOf(x + right.x, y + right.y, z)[0] - stage.pixelOf(x, y, z)[0];
    const step = right.multiplyScalar(-pixels / metre);
    const zoom = stage.isAbove && camera.zoom;
    const from = { position: camera.position.toArray(), target: controls.target.toArray(), zoom };
    const to = { position: camera.position.clone().add(step).toArray(), target: controls.target.clone().add(step).toArray(), zoom };
    if (STILL.matches) this.take(to);
    else {
      this.flight = { from, to, since: performance.now() };
      stage.invalidate();
    }
  }

  /** Follows what `place()` returns; null ends it. */
  follow(place) {
    this.followed = place;
    if (place) this.visit(place());
  }

  /** Moves the camera before each picture; returns whether it is under way. */
  advance(now = performance.now()) {
    if (this.flight) this.fly(now);
    else if (this.followed) this.goAlong();
    return Boolean(this.flight);
  }

  fly(now) {
    const { from, to, since } = this.flight, part = Math.min(1, (now - since) / FLIGHT);
    const eased = part * part * (3 - 2 * part);
    const between = (a, b) => a.map((value, i) => value + eased * (b[i] - value));
    if (part === 1) this.flight = null;
    this.take({ position: between(from.position, to.position), target: between(from.target, to.target),
      zoom: to.zoom && from.zoom * (to.zoom / from.zoom) ** eased });
  }

  goAlong() {
    const [x, y, z] = this.followed();
    const { camera, controls } = this.stage;
    const step = new THREE.Vector3(x, y, z).sub(controls.target);
    if (step.lengthSq() === 0) return;
    controls.target.add(step);
    camera.position.add(step);
    camera.lookAt(controls.target);
  }
}
