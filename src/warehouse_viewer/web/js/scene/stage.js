// SPDX-License-Identifier: Apache-2.0
// The scene, its light and floor; drawn only when something changed.

import * as THREE from '/three/build/three.module.js';
import { OrbitControls } from '/three/examples/jsm/controls/OrbitControls.js';
import { Backdrop, Renewal, STILL } from './backdrop.js';
import { on, token } from '../base/dom.js';
import { Pace } from './pace.js';
import { Paint, behind } from './paint.js';
import { drawsInSoftware } from '../base/software.js';

const GROUND = { dark: 0x565b66, light: 0x9a9a9a }; // what the floor reflects
const MOST_LINES = 600; // of the grid, along each axis

const point = new THREE.Vector3();

THREE.Object3D.DefaultUp.set(0, 0, 1);

export class Stage {
  /** `beforeDraw(now)` moves things and returns whether it will have to again. Where the processor
   *  draws, `onPace(gap)` hears the time from one picture to the next [ms]. */
  constructor(canvas, beforeDraw, onPace) {
    this.canvas = canvas;
    this.beforeDraw = beforeDraw;
    this.pace = new Pace(onPace);
    // Where the processor draws, smooth and finer edges cost more than they are worth.
    this.fenced = drawsInSoftware() ? canvas.getContext('webgl2', { alpha: false, antialias: false }) : null;
    this.renderer = new THREE.WebGLRenderer({ canvas, context: this.fenced ?? undefined, antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, this.fenced ? 1 : 2));
    this.scene = new THREE.Scene();
    this.backdrop = this.fenced && new Backdrop(this.renderer, this.scene);
    this.renewal = new Renewal();
    this.slanted = new THREE.PerspectiveCamera(45, 1, 0.1, 5000);
    this.slanted.position.set(0, -10, 10);
    // Looks straight down with parallel rays; its zoom is pixels a metre.
    this.upright = new THREE.OrthographicCamera(-1, 1, 1, -1, 1, 2000);
    this.camera = this.slanted;
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.controls.screenSpacePanning = false;
    this.controls.enableKeys = false;
    this.controls.addEventListener('change', () => {
      this.pace.hurry();
      this.invalidate();
    });
    this.sky = new THREE.HemisphereLight(0xffffff, 0x777777, 0.62);
    this.sun = new THREE.DirectionalLight(0xffffff, 0.36);
    this.sun.position.set(-3, -5, 9);
    for (const light of [this.sky, this.sun]) light.layers.enable(STILL);
    this.scene.add(this.sky, this.sun);
    this.paint = new Paint(this.scene);
    this.frames = 0; // drawn since the start
    this.acts = []; // to be done before the next picture
    this.margins = { left: 0, right: 0, top: 0, bottom: 0 };
    this.setFloor([-5, 5, -5, 5], 1);
    on(window, 'resize', () => this.resize());
    this.resize();
  }

  resize() {
    this.renderer.setSize(innerWidth, innerHeight, false);
    this.slanted.aspect = innerWidth / innerHeight;
    const [x, y] = [innerWidth / 2, innerHeight / 2];
    Object.assign(this.upright, { left: -x, right: x, top: y, bottom: -y });
    this.setMargins(this.margins);
  }

  /** Looks from above without perspective, where dragging moves the floor, or aslant. */
  lookFromAbove(above) {
    const { controls } = this;
    this.camera = controls.object = above ? this.upright : this.slanted;
    controls.enableRotate = !above;
    controls.screenSpacePanning = above;
    controls.mouseButtons.LEFT = above ? THREE.MOUSE.PAN : THREE.MOUSE.ROTATE;
    controls.touches.ONE = above ? THREE.TOUCH.PAN : THREE.TOUCH.ROTATE;
    this.isAbove = above;
    this.invalidate();
  }

  /** What panels cover at the edges of the window [px]: what is looked at belongs in the middle of
   *  the rest. */
  setMargins(margins) {
    const { left, right, top, bottom } = this.margins = margins;
    for (const camera of [this.slanted, this.upright]) {
      camera.setViewOffset(innerWidth, innerHeight,
        (right - left) / 2, (bottom - top) / 2, innerWidth, innerHeight);
    }
    this.invalidate();
  }

  /** Where a point of the world is drawn [px]. */
  pixelOf(x, y, z) {
    const at = point.set(x, y, z).project(this.camera);
    return [(at.x + 1) / 2 * innerWidth, (1 - at.y) / 2 * innerHeight];
  }

  /** The middle of what panels leave free [px]. */
  middle() {
    const { left, right, top, bottom } = this.margins;
    return [(left + innerWidth - right) / 2, (top + innerHeight - bottom) / 2];
  }

  /** Enlarges all by a factor. */
  zoom(factor) {
    const { camera, controls } = this;
    if (this.isAbove) camera.zoom *= factor;
    else camera.position.sub(controls.target).divideScalar(factor).add(controls.target);
    camera.updateProjectionMatrix();
    controls.update();
    this.invalidate();
  }

  /** Something looks other than it did: draw, soon and once. */
  invalidate() {
    this.isStale = true;
    this.wake();
  }

  /** Calls `act` just before the next picture, so that what it changes in the page is shown with it. */
  soon(act) {
    this.acts.push(act);
    this.wake();
  }

  async wake() {
    if (this.isAwake) return;
    this.isAwake = true;
    await this.pace.rest;
    requestAnimationFrame(() => this.turn());
  }

  turn() {
    try {
      while (this.acts.length) this.acts.shift()();
      if (this.isStale) this.draw(performance.now());
    } finally {
      this.isAwake = false;
      if (this.isStale || this.acts.length) this.wake();
    }
  }

  draw(now) {
    this.isStale = this.beforeDraw(now);
    this.render(now);
    this.frames += 1;
    if (this.fenced) this.pace.drew(now, fence(this.fenced));
  }

  render(now) {
    if (this.backdrop) {
      this.backdrop.draw(this.camera, this.renewal.take(now));
      return;
    }
    this.camera.layers.enable(STILL);
    this.renderer.render(this.scene, this.camera);
  }

  /** Whether the picture of that time [ms] takes in what stands still: at once where the `view` is another,
   *  soon where something came or went. */
  settles(now, view, changed) {
    if (view) this.renewal.ask();
    return !this.backdrop || this.renewal.settles(now, changed);
  }

  /** What stands still looks other. */
  renew() {
    this.renewal.ask();
    this.invalidate();
  }

  setTheme(theme) {
    this.scene.background = new THREE.Color(token('cell-nothing'));
    this.floor.material.color.set(token('cell-floor'));
    this.grid.material.color.set(token('cell-grid'));
    this.paint.renew();
    this.sky.groundColor.set(GROUND[theme]);
    this.renew();
  }

  /** What is painted on the floor, as a scene {paint, arrows} has it. */
  setPaint(scene) {
    this.paint.set(scene);
    this.renew();
  }

  /** bounds [min x, max x, min y, max y] and the spacing of grid points [m]. */
  setFloor(bounds, spacing) {
    if (this.floor) this.scene.remove(this.floor, this.grid);
    this.bounds = bounds;
    const [x0, x1, y0, y1] = bounds;
    const slab = new THREE.PlaneBufferGeometry(x1 - x0, y1 - y0);
    this.floor = new THREE.Mesh(slab, new THREE.MeshBasicMaterial(behind(2)));
    this.floor.position.set((x0 + x1) / 2, (y0 + y1) / 2, -0.01);
    this.grid = new THREE.LineSegments(gridOf(bounds, spacing), new THREE.LineBasicMaterial());
    for (const part of [this.floor, this.grid]) part.layers.set(STILL);
    this.scene.add(this.floor, this.grid);
    this.setTheme(document.documentElement.dataset.theme);
  }
}

/** A function that returns whether all that was drawn until now is done. */
function fence(gl) {
  const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl.flush();
  return () => gl.isContextLost() || gl.getSyncParameter(sync, gl.SYNC_STATUS) === gl.SIGNALED;
}

/** The borders of the cells, which lie midway between grid points; at most MOST_LINES of them. */
export function bordersOf(from, to, spacing) {
  const step = spacing * Math.max(1, Math.ceil((to - from) / spacing / MOST_LINES));
  const first = Math.ceil((from - spacing / 2) / spacing) * spacing + spacing / 2;
  const count = Math.floor((to - first) / step + 1e-6) + 1;
  return Array.from({ length: Math.max(0, count) }, (_, i) => first + i * step);
}

function gridOf([x0, x1, y0, y1], spacing) {
  const points = [];
  for (const x of bordersOf(x0, x1, spacing)) points.push(x, y0, 0, x, y1, 0);
  for (const y of bordersOf(y0, y1, spacing)) points.push(x0, y, 0, x1, y, 0);
  const out = new THREE.BufferGeometry();
  out.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
  return out;
}
