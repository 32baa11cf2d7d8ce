// SPDX-License-Identifier: Apache-2.0
// Robots, storage units, items and scenery in the picture, kept where the World has them.

import * as THREE from '/three/build/three.module.js';
import { Belts } from './belts.js';
import { Crowd, FAR, NEAR, View } from './crowd.js';
import { boundsOf, boxesOf, hull, materialOf, matrixOf, merge } from './looks.js';
import { Robots } from './robots.js';

// From so many pixels a metre on a thing is drawn in detail.
const DETAIL = { unit: 30, item: 30, scenery: 15 };

// Thousands of matrices a frame: this is reused.
const onUnit = new THREE.Matrix4();

export class Actors {
  constructor(stage, world) {
    Object.assign(this, { stage, world });
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
    this.units = this.crowd('unit', look(scene.unit_look), scene.units.length, true);
    this.items = this.crowd('item', look(scene.item_look), scene.items.length, false);
    this.itemPlace = scene.items.map((_, i) => matrixOf(scene.item_pose.slice(7 * i, 7 * i + 7)));
    this.buildScenery(look);
    this.setSeeThrough(this.seeThrough);
    this.stage.invalidate();
  }

  /** A Crowd of `count` alike; those far away are boxes, or not drawn at all. */
  crowd(kind, links, count, hasHull) {
    const out = new Crowd(this.group, count, boundsOf(links), DETAIL[kind]);
    if (!links.some((link) => link.shapes.length)) return out;
    out.add(merge(links), materialOf(), NEAR);
    if (hasHull) out.add(hull(links), materialOf(), FAR);
    return out;
  }

  /** Of a thing {kind, index}: its bounds, as looks.js has them. */
  boundsOf({ kind, index }) {
    return kind === 'scenery' ? this.bounds.scenery[index] : this.bounds[kind];
  }

  /** Where each of a kind stands: 16 numbers a thing. */
  baseOf(kind) {
    const crowds = { robot: this.robots.crowd, unit: this.units, item: this.items };
    return kind === 'scenery' ? this.sceneryBase : crowds[kind].base;
  }

  /** Before each picture: what is drawn in detail, how, and what not. */
  fill(camera, height) {
    const moved = this.view.update(camera, height);
    const crowds = [this.robots.crowd, this.units, this.items, ...this.sceneryCrowds, this.belts.slats];
    for (const crowd of crowds) {
      crowd.fill(this.view, moved);
    }
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
    this.units.put(unit, matrix);
    for (const item of this.world.itemsOf[unit]) {
      this.items.put(item, onUnit.multiplyMatrices(matrix, this.itemPlace[item]));
    }
  }

  placeLoose(items) {
    for (const item of items) {
      if (this.world.scene.item_unit[item] >= 0) continue;
      this.items.put(item, poseMatrix(this.world.loosePose, item));
    }
  }

  setSeeThrough(through) {
    this.seeThrough = through;
    for (const { copies: { mesh } } of [...this.units.layers, ...this.items.layers]) {
      Object.assign(mesh.material, { transparent: through, opacity: through ? 0.18 : 1, depthWrite: !through });
      mesh.material.needsUpdate = true;
      mesh.renderOrder = through ? 1 : 0;
    }
    this.stage.invalidate();
  }

  // --- scenery
  buildScenery(look) {
    const { scenery, scenery_look: looks } = this.world.scene;
    this.sceneryBase = new Float32Array(16 * scenery.length);
    this.sceneryPlaces = scenery.map(() => null); // {crowd, index} of each
    this.sceneryCrowds = [...new Set(looks)].map((index) => {
      const models = scenery.map((_, i) => i).filter((i) => looks[i] === index);
      const crowd = this.crowd('scenery', look(index), models.length, true);
      models.forEach((model, i) => { this.sceneryPlaces[model] = { crowd, index: i }; });
      return crowd;
    });
    const belts = scenery.map((_, i) => i).filter((i) => scenery[i].startsWith('conveyor_belt'));
    this.belts = new Belts(this.group, belts, look(looks[belts[0]]), this.sceneryBase, DETAIL.scenery);
  }

  placeScenery(models) {
    for (const model of models) {
      const matrix = poseMatrix(this.world.sceneryPose, model);
      matrix.toArray(this.sceneryBase, 16 * model);
      const { crowd, index } = this.sceneryPlaces[model];
      crowd.put(index, matrix);
    }
    if (models.length) this.belts.run(0);
  }
}


function poseMatrix(poses, i) {
  return matrixOf(poses.subarray(7 * i, 7 * i + 7));
}
