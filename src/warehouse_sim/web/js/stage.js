// SPDX-License-Identifier: Apache-2.0
// The scene, its light and floor; drawn only when something changed.

import * as THREE from '/three/build/three.module.js';
import { OrbitControls } from '/three/examples/jsm/controls/OrbitControls.js';

const COLOURS = {
  dark: { page: 0x14171c, floor: 0x2a2f37, grid: 0x414955, sky: 0xffffff, ground: 0x565b66 },
  light: { page: 0xeef1f4, floor: 0xd5dae0, grid: 0xb4bcc6, sky: 0xffffff, ground: 0x9a9a9a },
};
const PANELS_BELOW = 110; // how much more they cover there than above [px]
const MOST_LINES = 600; // of the grid, along each axis

THREE.Object3D.DefaultUp.set(0, 0, 1);

export class Stage {
  /** `beforeDraw(now)` moves things and returns whether it will have to again. */
  constructor(canvas, beforeDraw) {
    this.canvas = canvas;
    this.beforeDraw = beforeDraw;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(45, 1, 0.1, 5000);
    this.camera.position.set(0, -10, 10);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = 0.495 * Math.PI;
    this.controls.screenSpacePanning = false;
    this.controls.enableKeys = false;
    this.controls.addEventListener('change', () => this.invalidate());
    this.sky = new THREE.HemisphereLight(0xffffff, 0x777777, 0.62);
    this.sun = new THREE.DirectionalLight(0xffffff, 0.36);
    this.sun.position.set(-3, -5, 9);
    this.scene.add(this.sky, this.sun);
    this.frames = 0; // drawn since the start
    this.setFloor([-5, 5, -5, 5], 1);
    addEventListener('resize', () => this.resize());
    this.resize();
  }

  resize() {
    const [width, height] = [innerWidth, innerHeight];
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // What is looked at belongs in the middle of what the panels leave free.
    this.camera.setViewOffset(width, height, 0, PANELS_BELOW / 2, width, height);
    this.invalidate();
  }

  /** Something looks other than it did: draw, soon and once. */
  invalidate() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame((now) => this.draw(now));
  }

  draw() {
    this.asked = false;
    if (this.beforeDraw(performance.now())) this.invalidate();
    this.renderer.render(this.scene, this.camera);
    this.frames += 1;
  }

  setTheme(theme) {
    this.colours = COLOURS[theme];
    this.scene.background = new THREE.Color(this.colours.page);
    this.floor.material.color.set(this.colours.floor);
    this.grid.material.color.set(this.colours.grid);
    this.sky.color.set(this.colours.sky);
    this.sky.groundColor.set(this.colours.ground);
    this.invalidate();
  }

  /** bounds [min x, max x, min y, max y] and the spacing of grid points [m]. */
  setFloor(bounds, spacing) {
    if (this.floor) this.scene.remove(this.floor, this.grid);
    this.bounds = bounds;
    const [x0, x1, y0, y1] = bounds;
    const slab = new THREE.PlaneBufferGeometry(x1 - x0, y1 - y0);
    this.floor = new THREE.Mesh(slab, new THREE.MeshBasicMaterial());
    this.floor.position.set((x0 + x1) / 2, (y0 + y1) / 2, -0.01);
    this.grid = new THREE.LineSegments(gridOf(bounds, spacing), new THREE.LineBasicMaterial());
    this.scene.add(this.floor, this.grid);
    this.setTheme(document.documentElement.dataset.theme);
  }
}

/** The borders of the cells, which lie midway between grid points. */
function gridOf([x0, x1, y0, y1], spacing) {
  const points = [];
  const each = (from, to, add) => {
    const step = spacing * Math.max(1, Math.ceil((to - from) / spacing / MOST_LINES));
    const first = Math.ceil((from - spacing / 2) / spacing) * spacing + spacing / 2;
    for (let at = first; at <= to + 1e-6; at += step) add(Math.min(at, to));
  };
  each(x0, x1, (x) => points.push(x, y0, 0, x, y1, 0));
  each(y0, y1, (y) => points.push(x0, y, 0, x1, y, 0));
  const out = new THREE.BufferGeometry();
  out.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
  return out;
}
