// SPDX-License-Identifier: Apache-2.0
// Robots, storage units, items and scenery in the picture, kept where the World has them.

import * as THREE from '/three/build/three.module.js';
import { Belts } from './belts.js';
import { FAR, NEAR, StandingCrowd, TINY, View } from './crowd.js';
import { ALL, boundsOf, boxesOf, hull, materialOf, matrixOf, merge } from './looks.js';
import { COLOURS, Robots } from './robots.js';
import { addShadows } from './shadows.js';
import { boardsOf, flatMaterial, shelfGeometry, shelfPicture, speckGeometry, variantOf } from './shelves.js';

// Scale from which a thing is drawn in detail [px/m].
const DETAIL = { unit: 110, item: 110, scenery: 15 };
// Colours of storage units that stand, and of walls, by theme.
const STEEL = { dark: new THREE.Color(0xb9c2ce), light: new THREE.Color(0xf7f9fb) };
const WALL = { dark: new THREE.Color(0x5a6473), light: new THREE.Color(0xaab3be) };
const isWall = (name) => /^(layout_walls|wall|pillar|column)/.test(name);

// Thousands of matrices a frame: this is reused.
const onUnit = new THREE.Matrix4();

export class Actors {
  constructor(stage, world) {
    Object.assign(this, { stage, world, theme: document.documentElement.dataset.theme });
    this.group = new THREE.Group();
    stage.scene.add(this.group);
    this.view = new View();
    this.seeThrough = false;
    this.build();
  }

  /** Rebuilds everything for the World's scene. */
  build() {
    for (const mesh of this.group.children) mesh.geometry.dispose();
    this.group.remove(...this.group.children);
    const { scene } = this.world;
    const look = (index) => scene.looks[index] ?? [];
    // What the picker needs: shapes and sizes by kind; of scenery by model.
    const each = (make) => ({
      robot: make(look(scene.robot_look)),
      unit: make(look(scene.unit_look)),
      item: make(look(scene.item_look)),
      scenery: scene.scenery_look.map((index) => make(look(index))),
    });
    this.boxes = each(boxesOf);
    this.bounds = each(boundsOf);
    this.robots = new Robots(this.group, this.world, look(scene.robot_look));
    this.buildUnits(look(scene.unit_look));
    this.items = new StandingCrowd(this.group, scene.items.length, this.bounds.item, DETAIL.item, 0);
    if (hasShapes(look(scene.item_look))) this.items.add(merge(look(scene.item_look)), materialOf(), NEAR);
    this.itemPlace = scene.items.map((_, i) => matrixOf(scene.item_pose.slice(7 * i, 7 * i + 7)));
    this.buildScenery(look);
    this.setSeeThrough(this.seeThrough);
    this.stage.invalidate();
  }

  /** Units that stand are drawn by squares of the floor, as full as they are. */
  buildUnits(links) {
    const { units } = this.world.scene, bounds = this.bounds.unit;
    this.units = new StandingCrowd(this.group, units.length, bounds, DETAIL.unit, 0); // the far show as much
    const most = Math.max(1, ...this.world.itemsOf.map((items) => items.length));
    this.variants = this.world.itemsOf.map((items, unit) => variantOf(items.length / most, unit));
    if (!hasShapes(links)) return;
    const boards = boardsOf(links);
    addShadows(this.units, bounds, NEAR | FAR);
    this.units.add(merge(links, ALL), materialOf(true), NEAR);
    if (boards.length) this.units.add(shelfGeometry(links), flatMaterial(shelfPicture(boards)), FAR);
    else this.units.add(hull(links, true), materialOf(true), FAR);
    this.units.add(speckGeometry(bounds), flatMaterial(), TINY);
  }

  /** The bounds of a thing {kind, index}, as looks.js has them. */
  boundsOf({ kind, index }) {
    return kind === 'scenery' ? this.bounds.scenery[index] : this.bounds[kind];
  }

  /** Where each of a kind stands: 16 numbers a thing. */
  baseOf(kind) {
    const crowds = { robot: this.robots.crowd, unit: this.units, item: this.items };
    return kind === 'scenery' ? this.sceneryBase : crowds[kind].base;
  }

  /** All that are drawn as crowds. */
  get crowds() {
    return [this.robots.crowd, this.units, this.items, ...this.sceneryCrowds, this.belts.slats];
  }

  /** Chooses before a picture, by its time [ms], what is drawn in detail, and how. Returns whether the
   *  backdrop has to be drawn soon. */
  fill(camera, height, now) {
    const moved = this.view.update(camera, height);
    const standing = [this.units, this.items, ...this.sceneryCrowds];
    const changed = standing.some((crowd) => crowd.isUnsettled);
    const settles = this.stage.settles(now, moved, changed);
    for (const crowd of [this.robots.crowd, ...standing, this.belts.slats]) crowd.fill(this.view, moved, settles);
    return changed && !settles;
  }

  /** Puts these robots, and what they carry, where they are drawn now. */
  placeRobots(robots) {
    for (const i of robots) {
      this.robots.put(i);
      const load = this.world.loadOf(i);
      if (load >= 0) this.placeUnit(load);
    }
  }

  placeUnits(units) {
    for (const unit of units) this.placeUnit(unit);
  }

  placeUnit(unit) {
    const matrix = poseMatrix(this.world.unitPose, unit);
    const carrier = this.world.carrierOf(unit);
    if (carrier >= 0) matrix.premultiply(onUnit.fromArray(this.robots.crowd.base, 16 * carrier));
    this.units.put(unit, matrix, carrier >= 0);
    this.paintUnit(unit, carrier);
    for (const item of this.world.itemsOf[unit]) {
      this.items.put(item, onUnit.multiplyMatrices(matrix, this.itemPlace[item]), carrier >= 0);
    }
  }

  /** A carried unit has the colour of what its robot does. */
  paintUnit(unit, carrier) {
    const colour = carrier < 0 ? STEEL[this.theme] : COLOURS[this.world.activity[carrier]];
    this.units.paint(unit, colour, this.variants[unit]);
  }

  setTheme(theme) {
    this.theme = theme;
    for (let unit = 0; unit < this.variants.length; ++unit) this.paintUnit(unit, this.world.carrierOf(unit));
    this.paintWalls();
    this.stage.invalidate();
  }

  placeLoose(items) {
    for (const item of items) {
      if (this.world.scene.item_unit[item] >= 0) continue;
      this.items.put(item, poseMatrix(this.world.loosePose, item));
    }
  }

  setSeeThrough(through) {
    this.seeThrough = through;
    // What moves is seen through what stands.
    for (const crowd of [this.units, this.items]) crowd.setStill(!through);
    for (const { material, order } of [...this.units.layers, ...this.items.layers]) {
      if (order < 0) continue; // a shadow
      Object.assign(material, { transparent: through, opacity: through ? 0.18 : 1, depthWrite: !through });
      material.needsUpdate = true;
    }
    this.stage.renew();
  }

  // --- scenery
  buildScenery(look) {
    const { scenery, scenery_look: looks } = this.world.scene;
    this.sceneryBase = new Float32Array(16 * scenery.length);
    this.sceneryPlaces = scenery.map(() => null); // {crowd, index} of each
    this.sceneryCrowds = [...new Set(looks)].map((index) => {
      const models = scenery.map((_, i) => i).filter((i) => looks[i] === index);
      const crowd = this.crowdOf(look(index), models.length, isWall(scenery[models[0]]));
      models.forEach((model, i) => { this.sceneryPlaces[model] = { crowd, index: i }; });
      return crowd;
    });
    this.paintWalls();
    const belts = scenery.map((_, i) => i).filter((i) => scenery[i].startsWith('conveyor_belt'));
    this.belts = new Belts(this.group, belts, look(looks[belts[0]]), this.sceneryBase, DETAIL.scenery);
  }

  /** Scenery of one look; walls have a colour of the theme's. */
  crowdOf(links, count, areWalls) {
    const bounds = boundsOf(links), out = new StandingCrowd(this.group, count, bounds, DETAIL.scenery);
    if (!hasShapes(links)) return out;
    if (!areWalls) addShadows(out, bounds, NEAR | FAR);
    out.add(merge(links, areWalls && ALL), materialOf(true), NEAR);
    out.add(areWalls ? merge(links, ALL) : hull(links), materialOf(true), FAR | TINY);
    return out;
  }

  paintWalls() {
    for (const { crowd, index } of this.sceneryPlaces) crowd.paint(index, WALL[this.theme]);
  }

  placeScenery(models) {
    for (const model of models) {
      const matrix = poseMatrix(this.world.sceneryPose, model), at = 16 * model;
      const isThere = this.sceneryBase[at + 15] === 1;
      matrix.toArray(this.sceneryBase, at);
      const { crowd, index } = this.sceneryPlaces[model];
      crowd.put(index, matrix, isThere); // what is sent again is a person, or was pushed
    }
    if (models.length) this.belts.run(0);
  }
}

const hasShapes = (links) => links.some((link) => link.shapes.length);

function poseMatrix(poses, i) {
  return matrixOf(poses.subarray(7 * i, 7 * i + 7));
}
