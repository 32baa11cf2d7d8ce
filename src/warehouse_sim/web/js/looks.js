// SPDX-License-Identifier: Apache-2.0
// From looks, as the world tells them, to geometries and instanced meshes.

import * as THREE from '/three/build/three.module.js';

const ROUND = 12; // segments of a circle

function primitive(kind, [x, y, z]) {
  let out;
  if (kind === 1 || kind === 4) {
    out = new THREE.SphereBufferGeometry(0.5, ROUND, 6).scale(x, y, z);
  } else if (kind === 2) {
    out = new THREE.CylinderBufferGeometry(x / 2, x / 2, z, ROUND).rotateX(Math.PI / 2);
  } else if (kind === 3) {
    return capsule(x / 2, z - x);
  } else if (kind === 5) {
    out = new THREE.PlaneBufferGeometry(x, y);
  } else {
    out = new THREE.BoxBufferGeometry(x, y, z);
  }
  return [out];
}

function capsule(radius, length) {
  const ball = (z) => new THREE.SphereBufferGeometry(radius, ROUND, 6).translate(0, 0, z);
  const rod = new THREE.CylinderBufferGeometry(radius, radius, length, ROUND).rotateX(Math.PI / 2);
  return [rod, ball(length / 2), ball(-length / 2)];
}

export function matrixOf([x, y, z, qx, qy, qz, qw]) {
  return new THREE.Matrix4().compose(new THREE.Vector3(x, y, z),
    new THREE.Quaternion(qx, qy, qz, qw).normalize(), new THREE.Vector3(1, 1, 1));
}

const volume = ({ size: [x, y, z] }) => x * y * z;

/** All shapes of some links as one geometry, coloured by vertex. Where `painted`, the largest
 *  shape takes each instance's own tint instead. */
export function merge(links, painted = false) {
  const shapes = links.flatMap((link) => link.shapes.map((shape) => (
    { ...shape, matrix: matrixOf(link.pose).multiply(matrixOf(shape.pose)) })));
  const largest = Math.max(...shapes.map(volume));
  const parts = shapes.flatMap((shape) => primitive(shape.kind, shape.size).map((geometry) => ({
    geometry: geometry.toNonIndexed().applyMatrix(shape.matrix),
    colour: shape.colour,
    paint: painted && volume(shape) === largest ? 1 : 0,
  })));
  return joined(parts);
}

function joined(parts) {
  const count = parts.reduce((sum, { geometry }) => sum + geometry.attributes.position.count, 0);
  const arrays = { position: 3, normal: 3, color: 3, paint: 1 };
  const out = new THREE.BufferGeometry();
  for (const [name, size] of Object.entries(arrays)) {
    out.setAttribute(name, new THREE.BufferAttribute(new Float32Array(size * count), size));
  }
  let at = 0;
  for (const { geometry, colour, paint } of parts) {
    const { position, normal } = geometry.attributes;
    out.attributes.position.array.set(position.array, 3 * at);
    out.attributes.normal.array.set(normal.array, 3 * at);
    for (let i = at; i < at + position.count; ++i) {
      out.attributes.color.array.set(colour.slice(0, 3), 3 * i);
      out.attributes.paint.array[i] = paint;
    }
    at += position.count;
  }
  return out;
}

/** Boxes around the shapes, for picking: {inverse, half} in the model's frame. */
export function boxesOf(links) {
  return links.flatMap((link) => link.shapes.map((shape) => ({
    inverse: new THREE.Matrix4().getInverse(matrixOf(link.pose).multiply(matrixOf(shape.pose))),
    half: shape.size.map((edge) => edge / 2),
  })));
}

/** A material for instances; those of a tinted mesh have an attribute `tint`. */
export function materialOf(tinted = false) {
  const out = new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors });
  if (tinted) out.onBeforeCompile = takeTint;
  return out;
}

function takeTint(shader) {
  shader.vertexShader = shader.vertexShader
    .replace('#include <common>', '#include <common>\nattribute vec3 tint;\nattribute float paint;')
    .replace('#include <color_vertex>', '#include <color_vertex>\nvColor = mix(vColor, tint, paint);');
}

/** `count` instances of a geometry, all at the origin until placed. */
export function instances(geometry, material, count) {
  const out = new THREE.InstancedMesh(geometry, material, count);
  out.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
  out.frustumCulled = false;
  if (material.onBeforeCompile === takeTint) {
    const tint = new THREE.InstancedBufferAttribute(new Float32Array(3 * count), 3);
    geometry.setAttribute('tint', tint.setUsage(THREE.DynamicDrawUsage));
  }
  return out;
}
