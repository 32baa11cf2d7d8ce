// SPDX-License-Identifier: Apache-2.0
// Storage units as they are seen from afar: a box whose sides are a picture of boards and goods, as
// full as the unit is, in the colour of what its robot does while it is carried.

import * as THREE from '/three/build/three.module.js';
import { boundsOf, sizesOf } from './looks.js';

const FILLS = 4, KINDS = 4; // how full a side is drawn, and pictures of each
export const VARIANTS = FILLS * KINDS; // side by side in the picture
const WIDE = 64, HIGH = 128; // of a side [px]
const SHADE = { top: 1, x: 0.94, y: 0.8 }; // of its faces: the light stands still
// Cartons, totes and bags: muted, so that the colours of activities stand out.
const GOODS = [[201, 166, 120], [184, 146, 100], [214, 186, 146], [232, 232, 228], [124, 146, 170], [150, 168, 150], [170, 130, 110]];
const BACK = [74, 82, 94], FRAME = [255, 255, 255];

/** Heights of a look's boards [m]: shapes that are flat and reach over most of it. */
export function boardsOf(links) {
  const { min, max } = boundsOf(links);
  return sizesOf(links).filter(({ size }) => size[2] < 0.1 * (max[2] - min[2])
    && [0, 1].every((axis) => size[axis] > 0.6 * (max[axis] - min[axis])))
    .map(({ z }) => (z - min[2]) / (max[2] - min[2])).sort((a, b) => a - b);
}

/** Which picture a unit has: `full` from 0 (nothing lies on it) to 1, and any number. */
export function variantOf(full, number) {
  return KINDS * Math.round(Math.max(0, Math.min(1, full)) * (FILLS - 1)) + number % KINDS;
}

/** Four sides with the picture and a top in the unit's tint. */
export function shelfGeometry(links) {
  const { min, max } = boundsOf(links);
  const [[x0, y0, z0], [x1, y1, z1]] = [min, max];
  const sides = [
    [[x0, y0], [x1, y0], SHADE.y], [[x1, y0], [x1, y1], SHADE.x],
    [[x1, y1], [x0, y1], SHADE.y], [[x0, y1], [x0, y0], SHADE.x],
  ];
  const out = { position: [], uv: [], color: [], paint: [] };
  const corner = (at, uv, shade, paint) => {
    out.position.push(...at);
    out.uv.push(...uv);
    out.color.push(shade, shade, shade);
    out.paint.push(paint);
  };
  for (const [[ax, ay], [bx, by], shade] of sides) {
    corner([ax, ay, z0], [0, 0], shade, 0);
    corner([bx, by, z0], [1, 0], shade, 0);
    corner([bx, by, z1], [1, 1], shade, 0);
    corner([ax, ay, z1], [0, 1], shade, 0);
  }
  for (const at of [[x0, y0, z1], [x1, y0, z1], [x1, y1, z1], [x0, y1, z1]]) corner(at, [0, 1], SHADE.top, 1);
  return built(out, Array.from({ length: 5 }, (_, i) => [0, 1, 2, 0, 2, 3].map((k) => 4 * i + k)).flat());
}

/** Eight corners in the unit's tint, darker below: a few pixels. */
export function speckGeometry({ min, max }) {
  const out = { position: [], color: [], paint: [] };
  for (const [z, shade] of [[min[2], 0.55], [max[2], 1]]) {
    for (const [x, y] of [[min[0], min[1]], [max[0], min[1]], [max[0], max[1]], [min[0], max[1]]]) {
      out.position.push(x, y, z);
      out.color.push(shade, shade, shade);
      out.paint.push(1);
    }
  }
  return built(out, [0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7, 4, 5, 6, 4, 6, 7]);
}

function built(arrays, index) {
  const out = new THREE.BufferGeometry();
  for (const [name, array] of Object.entries(arrays)) {
    const size = { uv: 2, paint: 1 }[name] ?? 3;
    out.setAttribute(name, new THREE.Float32BufferAttribute(array, size));
  }
  out.setIndex(index);
  return out;
}

/** The pictures of sides, all variants in a row; what is opaque takes the unit's tint. */
export function shelfPicture(boards) {
  const width = WIDE * VARIANTS, data = new Uint8Array(4 * width * HIGH);
  const fill = (x0, y0, x1, y1, colour, mask = 0) => {
    for (let y = Math.max(0, y0); y < Math.min(HIGH, y1); ++y) {
      for (let x = x0; x < x1; ++x) data.set([...colour, mask], 4 * (y * width + x));
    }
  };
  for (let variant = 0; variant < VARIANTS; ++variant) drawSide(fill, variant, boards);
  const out = new THREE.DataTexture(data, width, HIGH, THREE.RGBAFormat);
  Object.assign(out, { magFilter: THREE.LinearFilter, minFilter: THREE.LinearMipMapNearestFilter,
    generateMipmaps: true, needsUpdate: true });
  return out;
}

function drawSide(fill, variant, boards) {
  const left = WIDE * variant, random = numbers(variant + 1);
  const share = Math.floor(variant / KINDS) / (FILLS - 1);
  fill(left, 0, left + WIDE, HIGH, BACK);
  const levels = boards.map((at) => Math.round(HIGH * at));
  levels.forEach((floor, i) => {
    const room = (levels[i + 1] ?? HIGH) - floor - 8;
    for (let x = left + 5; x < left + WIDE - 10;) {
      const wide = 8 + Math.floor(9 * random()), high = Math.floor(room * (0.45 + 0.5 * random()));
      const end = Math.min(x + wide, left + WIDE - 5), colour = GOODS[Math.floor(GOODS.length * random())];
      if (random() < 1.1 * share) {
        fill(x, floor + 2, end, floor + 2 + high, colour);
        fill(x, floor + 2, x + 1, floor + 2 + high, colour.map((c) => 0.7 * c)); // its edge
      }
      x = end + 2;
    }
  });
  for (const at of levels) fill(left, at - 2, left + WIDE, at + 2, FRAME, 255);
  for (const x of [left, left + WIDE - 4]) fill(x, 0, x + 4, HIGH, FRAME, 255);
  fill(left, HIGH - 3, left + WIDE, HIGH, FRAME, 255);
}

/** The same numbers in 0…1 for the same seed (mulberry32). */
function numbers(seed) {
  let state = seed * 0x9e3779b9;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/** A material for copies that have a tint; without light, which would cost more than it shows. */
export function flatMaterial(map = null) {
  const out = new THREE.MeshBasicMaterial({ map, vertexColors: THREE.VertexColors });
  out.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nattribute vec4 tint;\nattribute float paint;\nvarying vec4 vTint;')
      .replace('#include <uv_vertex>', `vTint = vec4(tint.rgb, paint);${map ? `\nvUv = vec2((uv.x * 0.98 + 0.01 + tint.w) / ${VARIANTS}.0, uv.y);` : ''}`);
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', '#include <common>\nvarying vec4 vTint;')
      .replace('#include <map_fragment>', map
        ? 'vec4 texel = texture2D(map, vUv);\ndiffuseColor.rgb = mix(texel.rgb, vTint.rgb, max(texel.a, vTint.a));'
        : 'diffuseColor.rgb = mix(diffuseColor.rgb, vTint.rgb, vTint.a);');
  };
  return out;
}
