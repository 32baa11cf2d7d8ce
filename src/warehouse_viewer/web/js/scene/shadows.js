// SPDX-License-Identifier: Apache-2.0
// Soft shadows that are painted, not computed: a blurred square on the floor beneath a thing.

import * as THREE from '/three/build/three.module.js';

const SIDE = 32; // of the picture [px]
const HEIGHT = 0.006; // over the floor [m]
const SOFT = 0.28; // its reach beyond the thing [m]
const DARK = 0.5; // where it is darkest
const UNDER_ALL = -1; // drawn first of what is transparent

let picture;

/** Adds a shadow to each of a crowd, at levels at which it shows; bounds as looks.js has them. */
export function addShadows(crowd, { min, max }, levels, soft = SOFT) {
  const geometry = new THREE.PlaneBufferGeometry(max[0] - min[0] + 2 * soft, max[1] - min[1] + 2 * soft);
  geometry.translate((min[0] + max[0]) / 2, (min[1] + max[1]) / 2, 0);
  geometry.deleteAttribute('normal');
  picture ??= shadowPicture(SIDE);
  const material = new THREE.MeshBasicMaterial({ map: picture, color: 0, transparent: true, depthWrite: false });
  crowd.add(geometry, material, levels, flat, UNDER_ALL);
}

/** Lays a matrix on the floor, upright. */
function flat(_, out, at) {
  out[at + 14] = HEIGHT;
}

/** A square with soft edges: white, its alpha from 0 at the border to DARK. */
function shadowPicture(side) {
  const data = new Uint8Array(4 * side * side);
  const ramp = (k) => {
    const far = Math.min(1, (side / 2 - Math.abs(k + 0.5 - side / 2)) / (0.42 * side));
    return far * far * (3 - 2 * far);
  };
  for (let i = 0; i < side * side; ++i) {
    const depth = ramp(i % side) * ramp(Math.floor(i / side));
    data.set([255, 255, 255, Math.round(255 * DARK * depth)], 4 * i);
  }
  const out = new THREE.DataTexture(data, side, side, THREE.RGBAFormat);
  Object.assign(out, { magFilter: THREE.LinearFilter, minFilter: THREE.LinearFilter, needsUpdate: true });
  return out;
}
