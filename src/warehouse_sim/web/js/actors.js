// SPDX-License-Identifier: Apache-2.0
// Robots, storage units, items and scenery as instanced meshes, kept where the World has them.

import * as THREE from '/three/build/three.module.js';
import { boxesOf, instances, materialOf, matrixOf, merge } from './looks.js';

// As style.css has them.
export const STATUS_COLOURS = [0x0072b2, 0xf0e442, 0xd55e00].map((c) => new THREE.Color(c));
const HALO = { inner: 0.40, outer: 0.49 }; // half edges of the frame around a robot [m]
const WHEEL_RADIUS = 0.1, WHEEL_TRACK = 0.52; // [m], as in worlds/models/kiva
const SLATS = 6, SLAT_WAY = 1.66, BELT_TOP = 0.592, BELT_SPEED = 0.4; // [m], [m/s]

// Thousands of matrices a frame: these are reused.
const scratch = new THREE.Matrix4();
const local = new THREE.Matrix4();
const turn = new THREE.Matrix4();

export class Actors {
  constructor(stage, world) {
    Object.assign(this, { stage, world });
    this.group = new THREE.Group();
    stage.scene.add(this.group);
    this.seeThrough = false;
    this.beltWay = 0;
    this.build();
  }

  /** Makes all anew, for the World's scene. */
  build() {
    for (const mesh of this.group.children) mesh.geometry.dispose();
    this.group.remove(...this.group.children);
    const { scene } = this.world;
    const look = (index) => scene.looks[index] ?? [];
    this.boxes = {
      robot: boxesOf(look(scene.robot_look)),
      unit: boxesOf(look(scene.unit_look)),
      item: boxesOf(look(scene.item_look)),
      scenery: scene.scenery_look.map((index) => boxesOf(look(index))),
    };
    // Where each stands, as the picker needs it too.
    this.base = {
      robot: matrices(scene.robots.length),
      unit: matrices(scene.units.length),
      item: matrices(scene.items.length),
      scenery: matrices(scene.scenery.length),
    };
    this.buildRobots(look(scene.robot_look), scene.robots.length);
    this.unitMesh = this.add(look(scene.unit_look), scene.units.length);
    this.itemMesh = this.add(look(scene.item_look), scene.items.length);
    this.itemPlace = scene.items.map((_, i) => matrixOf(scene.item_pose.slice(7 * i, 7 * i + 7)));
    this.buildScenery(look);
    this.setSeeThrough(this.seeThrough);
    this.stage.invalidate();
  }

  add(links, count, tinted = false) {
    if (!count || !links.some((link) => link.shapes.length)) return null;
    const mesh = instances(merge(links, tinted), materialOf(tinted), count);
    this.group.add(mesh);
    return mesh;
  }

  // --- robots
  buildRobots(links, count) {
    const moving = ['left_wheel', 'right_wheel', 'tower'];
    this.chassis = this.add(links.filter(({ name }) => !moving.includes(name)), count, true);
    this.joints = moving.map((name) => this.buildJoint(links.find((l) => l.name === name), count));
    this.rolled = new Float64Array(2 * count); // of the wheels, left and right [rad]
    this.halo = count ? instances(haloGeometry(), haloMaterial(), count) : null;
    if (this.halo) {
      const tint = new THREE.InstancedBufferAttribute(new Float32Array(3 * count), 3);
      this.halo.geometry.setAttribute('tint', tint);
      this.group.add(this.halo);
    }
  }

  buildJoint(link, count) {
    const mesh = link && this.add([{ ...link, pose: [0, 0, 0, 0, 0, 0, 1] }], count);
    return mesh && { mesh, place: matrixOf(link.pose) };
  }

  /** Colours of the robots at these indices. */
  paint(robots) {
    const meshes = [this.chassis, this.halo].filter(Boolean);
    for (const { geometry } of meshes) {
      const { tint } = geometry.attributes;
      for (const i of robots) STATUS_COLOURS[this.world.status[i]].toArray(tint.array, 3 * i);
      tint.needsUpdate = true;
    }
  }

  /** Puts these robots, and what they carry, where they are drawn now. */
  placeRobots(robots) {
    const { shown } = this.world;
    for (const i of robots) {
      const x = shown[3 * i], y = shown[3 * i + 1], yaw = shown[3 * i + 2];
      this.roll(i, x, y, yaw);
      planar(scratch, x, y, yaw).toArray(this.base.robot, 16 * i);
      for (const mesh of [this.chassis, this.halo]) mesh?.setMatrixAt(i, scratch);
      const load = this.world.loadOf(i);
      const tower = load < 0 ? 0 : Math.max(0, this.world.unitPose[7 * load + 2]);
      this.placeJoints(i, tower);
      if (load >= 0) this.placeUnit(load);
    }
    touch([this.chassis, this.halo, ...this.joints.map((joint) => joint?.mesh)]);
  }

  /** Turns the wheels by the way from where the robot was drawn last. */
  roll(i, x, y, yaw) {
    const old = this.base.robot, at = 16 * i;
    const c = old[at], s = old[at + 1]; // of the old heading
    const ahead = c * (x - old[at + 12]) + s * (y - old[at + 13]);
    const turned = Math.asin(Math.max(-1, Math.min(1, c * Math.sin(yaw) - s * Math.cos(yaw))));
    const apart = turned * WHEEL_TRACK / 2;
    this.rolled[2 * i] += (ahead - apart) / WHEEL_RADIUS;
    this.rolled[2 * i + 1] += (ahead + apart) / WHEEL_RADIUS;
  }

  placeJoints(i, tower) {
    this.joints.forEach((joint, which) => {
      if (!joint) return;
      local.copy(joint.place);
      if (which < 2) local.multiply(turn.makeRotationY(this.rolled[2 * i + which]));
      else local.elements[14] += tower;
      joint.mesh.setMatrixAt(i, local.premultiply(scratch));
    });
  }

  // --- storage units, items
  placeUnits(units) {
    for (const unit of units) this.placeUnit(unit);
  }

  placeUnit(unit) {
    const matrix = poseMatrix(this.world.unitPose, unit);
    const carrier = this.world.carrierOf(unit);
    if (carrier >= 0) matrix.premultiply(local.fromArray(this.base.robot, 16 * carrier));
    matrix.toArray(this.base.unit, 16 * unit);
    this.unitMesh?.setMatrixAt(unit, matrix);
    for (const item of this.world.itemsOf[unit]) {
      this.placeItem(item, local.multiplyMatrices(matrix, this.itemPlace[item]));
    }
    touch([this.unitMesh, this.itemMesh]);
  }

  placeItem(item, matrix) {
    matrix.toArray(this.base.item, 16 * item);
    this.itemMesh?.setMatrixAt(item, matrix);
  }

  placeLoose(items) {
    for (const item of items) {
      if (this.world.scene.item_unit[item] >= 0) continue;
      this.placeItem(item, poseMatrix(this.world.loosePose, item));
    }
    touch([this.itemMesh]);
  }

  setSeeThrough(on) {
    this.seeThrough = on;
    for (const mesh of [this.unitMesh, this.itemMesh]) {
      if (!mesh) continue;
      Object.assign(mesh.material, { transparent: on, opacity: on ? 0.18 : 1, depthWrite: !on });
      mesh.material.needsUpdate = true;
      mesh.renderOrder = on ? 1 : 0;
    }
    this.stage.invalidate();
  }

  // --- scenery
  buildScenery(look) {
    const { scenery, scenery_look: looks } = this.world.scene;
    this.sceneryPlaces = scenery.map(() => null); // {mesh, index} of each
    for (const index of new Set(looks)) {
      const models = scenery.map((_, i) => i).filter((i) => looks[i] === index);
      const mesh = this.add(look(index), models.length);
      if (mesh) models.forEach((model, i) => { this.sceneryPlaces[model] = { mesh, index: i }; });
    }
    this.belts = scenery.map((_, i) => i).filter((i) => scenery[i].startsWith('conveyor_belt'));
    const slat = new THREE.BoxBufferGeometry(0.05, 0.66, 0.004);
    const material = new THREE.MeshLambertMaterial({ color: 0x3a3d42 });
    this.slats = this.belts.length ? instances(slat, material, SLATS * this.belts.length) : null;
    if (this.slats) this.group.add(this.slats);
  }

  placeScenery(models) {
    for (const model of models) {
      const matrix = poseMatrix(this.world.sceneryPose, model);
      matrix.toArray(this.base.scenery, 16 * model);
      const place = this.sceneryPlaces[model];
      if (!place) continue;
      place.mesh.setMatrixAt(place.index, matrix);
      touch([place.mesh]);
    }
    if (models.length) this.runBelts(0);
  }

  /** Moves the belts' surfaces on by so many simulated seconds. */
  runBelts(seconds) {
    if (!this.slats) return;
    this.beltWay = (this.beltWay + BELT_SPEED * seconds) % SLAT_WAY;
    this.belts.forEach((model, i) => {
      scratch.fromArray(this.base.scenery, 16 * model);
      for (let slat = 0; slat < SLATS; ++slat) {
        const x = (this.beltWay + slat * SLAT_WAY / SLATS) % SLAT_WAY - SLAT_WAY / 2;
        local.makeTranslation(x, 0, BELT_TOP).premultiply(scratch);
        this.slats.setMatrixAt(SLATS * i + slat, local);
      }
    });
    touch([this.slats]);
  }
}

function matrices(count) {
  const out = new Float32Array(16 * count);
  for (let i = 0; i < count; ++i) scratch.identity().toArray(out, 16 * i);
  return out;
}

function touch(meshes) {
  for (const mesh of meshes) if (mesh) mesh.instanceMatrix.needsUpdate = true;
}

function planar(matrix, x, y, yaw) {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  return matrix.set(c, -s, 0, x, s, c, 0, y, 0, 0, 1, 0, 0, 0, 0, 1);
}

function poseMatrix(poses, i) {
  return matrixOf(poses.subarray(7 * i, 7 * i + 7));
}

/** A square frame on the floor, seen from above even beneath a storage unit. */
function haloGeometry() {
  const { inner, outer } = HALO;
  const shape = new THREE.Shape([[-1, -1], [1, -1], [1, 1], [-1, 1]]
    .map(([x, y]) => new THREE.Vector2(outer * x, outer * y)));
  shape.holes.push(new THREE.Path([[-1, -1], [-1, 1], [1, 1], [1, -1]]
    .map(([x, y]) => new THREE.Vector2(inner * x, inner * y))));
  return new THREE.ShapeBufferGeometry(shape).translate(0, 0, 0.012);
}

function haloMaterial() {
  const out = new THREE.MeshBasicMaterial();
  out.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace('#include <common>',
      '#include <common>\nattribute vec3 tint;\nvarying vec3 vTint;')
      .replace('#include <begin_vertex>', '#include <begin_vertex>\nvTint = tint;');
    shader.fragmentShader = shader.fragmentShader.replace('#include <common>',
      '#include <common>\nvarying vec3 vTint;')
      .replace('vec4 diffuseColor = vec4( diffuse, opacity );', 'vec4 diffuseColor = vec4(vTint, opacity);');
  };
  return out;
}
