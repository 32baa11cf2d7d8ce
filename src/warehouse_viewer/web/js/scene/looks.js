// SPDX-License-Identifier: Apache-2.0
// Geometries, sizes and instanced meshes of the world's looks.

import * as THREE from '/three/build/three.module.js';

const ROUND = 12; // segments of a circle
const PAD_HEIGHT = 0.012; // above the floor [m]
const SPHERE = 1, CYLINDER = 2, CAPSULE = 3, ELLIPSOID = 4, PLANE = 5; // as warehouse_msgs/Look

const plainBox = ([x, y, z]) => new THREE.BoxBufferGeometry(x, y, z);

function primitive(kind, [x, y, z], box) {
  if (kind === SPHERE || kind === ELLIPSOID) {
    return [new THREE.SphereBufferGeometry(0.5, ROUND, 6).scale(x, y, z)];
  }
  if (kind === CYLINDER) return [rod(x / 2, z)];
  if (kind === CAPSULE) return capsule(x / 2, z - x);
  if (kind === PLANE) return [new THREE.PlaneBufferGeometry(x, y)];
  return [box([x, y, z])];
}

function rod(radius, length) {
  return new THREE.CylinderBufferGeometry(radius, radius, length, ROUND).rotateX(Math.PI / 2);
}

function capsule(radius, length) {
  const ball = (z) => new THREE.SphereBufferGeometry(radius, ROUND, 6).translate(0, 0, z);
  return [rod(radius, length), ball(length / 2), ball(-length / 2)];
}

export function matrixOf([x, y, z, qx, qy, qz, qw]) {
  return new THREE.Matrix4().compose(new THREE.Vector3(x, y, z),
    new THREE.Quaternion(qx, qy, qz, qw).normalize(), new THREE.Vector3(1, 1, 1));
}

const volume = ({ size: [x, y, z] }) => x * y * z;

/** All shapes of some links, each with its matrix in the model. */
function shapesOf(links) {
  return links.flatMap((link) => link.shapes.map((shape) => (
    { ...shape, matrix: matrixOf(link.pose).multiply(matrixOf(shape.pose)) })));
}

/** The shape of the largest volume, with its matrix in the model; undefined if there is none. */
export function largestOf(links) {
  const shapes = shapesOf(links);
  const most = Math.max(...shapes.map(volume));
  return shapes.find((shape) => volume(shape) === most);
}

/** The extents of each shape along the axes of the model, and the height of its middle [m]. */
export function sizesOf(links) {
  return shapesOf(links).map(({ matrix, size }) => {
    const half = new THREE.Vector3(...size).multiplyScalar(0.5);
    const box = new THREE.Box3(half.clone().negate(), half).applyMatrix4(matrix);
    return { size: box.getSize(new THREE.Vector3()).toArray(), z: (box.min.z + box.max.z) / 2 };
  });
}

export const ALL = 'all'; // shapes are painted

/** All shapes of some links as one geometry, coloured by vertex. Where `painted`, the largest shape (or
 *  ALL, or each by the share that a function gives it) takes each instance's own tint instead; `box`
 *  makes the geometry of boxes. */
export function merge(links, painted = false, box = plainBox) {
  const largest = largestOf(links);
  const paintOf = typeof painted === 'function' ? painted
    : (shape) => (painted === ALL || (painted && volume(shape) === volume(largest)) ? 1 : 0);
  return joined(shapesOf(links).flatMap((shape) => primitive(shape.kind, shape.size, box).map((geometry) => ({
    geometry: (geometry.index ? geometry.toNonIndexed() : geometry).applyMatrix(shape.matrix),
    colour: shape.colour,
    paint: paintOf(shape),
  }))));
}

/** One box around all shapes, in the colour of the largest or, where `painted`, in each
 *  instance's own tint: what is left of a thing that is far away. It has no bottom, but a square of
 *  half edge `pad` on the floor if one is given. */
export function hull(links, painted = false, pad = 0) {
  const { min, max } = boundsOf(links);
  const faces = [2, 0, 1].flatMap((axis) => [0, 1].map((side) => face(axis, side, min, max))).slice(1);
  if (pad) faces.push(face(2, 1, [-pad, -pad, PAD_HEIGHT], [pad, pad, PAD_HEIGHT]));
  const out = new THREE.BufferGeometry();
  const set = (name, size, rows) => out.setAttribute(name, new THREE.Float32BufferAttribute(rows.flat(), size));
  const corners = faces.flatMap((f) => f.corners);
  set('position', 3, corners);
  set('normal', 3, faces.flatMap(({ normal }) => Array(4).fill(normal)));
  set('color', 3, corners.map(() => largestOf(links).colour.slice(0, 3)));
  set('paint', 1, corners.map(() => (painted ? 1 : 0)));
  // Few corners, each shared by two triangles: where they are drawn in software this is half of it.
  out.setIndex(faces.flatMap((_, i) => [0, 1, 2, 0, 2, 3].map((corner) => 4 * i + corner)));
  return out;
}

/** {corners, normal} of the lower (0) or upper (1) side of a box along an axis, seen
 *  counterclockwise from outside. */
function face(axis, side, min, max) {
  const [u, v] = side ? [(axis + 1) % 3, (axis + 2) % 3] : [(axis + 2) % 3, (axis + 1) % 3];
  const normal = [0, 0, 0];
  normal[axis] = side ? 1 : -1;
  const corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(([a, b]) => {
    const at = [0, 0, 0];
    at[axis] = side ? max[axis] : min[axis];
    at[u] = a ? max[u] : min[u];
    at[v] = b ? max[v] : min[v];
    return at;
  });
  return { corners, normal };
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
  return shapesOf(links).map(({ matrix, size }) => ({
    inverse: new THREE.Matrix4().getInverse(matrix),
    half: size.map((edge) => edge / 2),
  }));
}

/** What all shapes reach over, in the model's frame [m]: {min, max, centre, radius}, the last two
 *  of a sphere around them. Without shapes a point at the origin. */
export function boundsOf(links) {
  const box = new THREE.Box3();
  for (const { matrix, size } of shapesOf(links)) {
    const half = new THREE.Vector3(...size).multiplyScalar(0.5);
    box.union(new THREE.Box3(half.clone().negate(), half).applyMatrix4(matrix));
  }
  if (box.isEmpty()) box.expandByPoint(new THREE.Vector3());
  const centre = box.getCenter(new THREE.Vector3());
  return { min: box.min.toArray(), max: box.max.toArray(), centre: centre.toArray(),
    radius: centre.distanceTo(box.max) };
}

/** A material for instances; those of a tinted mesh have an attribute `tint`. */
export function materialOf(tinted = false) {
  const out = new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors });
  if (tinted) out.onBeforeCompile = takeTint;
  return out;
}

export function takeTint(shader) {
  shader.vertexShader = shader.vertexShader
    .replace('#include <common>', '#include <common>\nattribute vec3 tint;\nattribute float paint;')
    .replace('#include <color_vertex>', '#include <color_vertex>\nvColor = mix(vColor, tint, paint);');
}
