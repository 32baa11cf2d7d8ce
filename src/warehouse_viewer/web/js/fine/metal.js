// SPDX-License-Identifier: Apache-2.0
// Materials of robots, belts, people, storage units and walls: they reflect a hall with lamps, and are lit as
// film is.

import * as THREE from '/three/build/three.module.js';
import { takeTint } from '../scene/looks.js';

const SIDE = 32; // of the pictures of the hall [px]
const SMOOTH = { roughness: 0.42, metalness: 0.35, envMapIntensity: 0.55 };
// The curve of Narkowicz, "ACES filmic tone mapping curve" (2015).
const FILM = `gl_FragColor.rgb *= 0.82;
gl_FragColor.rgb = clamp(gl_FragColor.rgb * (2.51 * gl_FragColor.rgb + 0.03) / (gl_FragColor.rgb * (2.43 * gl_FragColor.rgb + 0.59) + 0.14), 0.0, 1.0);`;

let hall;

/** Gives a crowd the fine materials, and shadows to what stands on the floor. */
export function dress(crowd, renderer) {
  for (const layer of crowd.layers) {
    if (layer.order !== 0) continue; // a shadow or an outline
    layer.casts = true;
    if (layer.material.isMeshLambertMaterial) {
      layer.plain = layer.material;
      layer.material = fineMaterial(layer.plain, renderer);
    }
  }
  apply(crowd);
}

/** Takes them away. */
export function undress(crowd) {
  for (const layer of crowd.layers) {
    layer.casts = false;
    if (layer.plain) {
      const { transparent, opacity, depthWrite } = layer.material; // as seen through by now
      layer.material = Object.assign(layer.plain, { transparent, opacity, depthWrite });
    }
    layer.plain = null;
  }
  apply(crowd);
}

function apply(crowd) {
  for (const { copies } of crowd.parts) {
    copies.forEach((copy, i) => {
      if (copy) Object.assign(copy.mesh, { material: crowd.layers[i].material, castShadow: Boolean(crowd.layers[i].casts) });
    });
  }
}

function fineMaterial({ vertexColors, color, transparent, opacity, depthWrite, onBeforeCompile }, renderer) {
  hall ??= hallPicture(renderer);
  const out = new THREE.MeshStandardMaterial({ ...SMOOTH, vertexColors, color, transparent, opacity, depthWrite, envMap: hall });
  const isTinted = onBeforeCompile === takeTint;
  out.onBeforeCompile = (shader) => {
    if (isTinted) takeTint(shader);
    shader.fragmentShader = shader.fragmentShader.replace('#include <tonemapping_fragment>', FILM);
  };
  // Programs are shared by the text of this function.
  out.onBeforeCompile.toString = () => `fine ${isTinted}`;
  return out;
}

/** Six faces of a hall: a dark floor, bright walls, rows of lamps on the ceiling. Up is z. */
function hallPicture() {
  const faces = ['+x', '-x', '+y', '-y', '+z', '-z'].map((face) => {
    const texels = new Uint8Array(4 * SIDE * SIDE);
    for (let i = 0; i < SIDE * SIDE; ++i) {
      const level = brightness(face, i % SIDE, Math.floor(i / SIDE));
      texels.set([level, level, Math.min(255, level * 1.04), 255], 4 * i);
    }
    const out = new THREE.DataTexture(texels, SIDE, SIDE, THREE.RGBAFormat);
    out.needsUpdate = true;
    return out;
  });
  const out = new THREE.CubeTexture(faces, undefined, undefined, undefined, THREE.LinearFilter, THREE.LinearMipMapLinearFilter);
  Object.assign(out, { format: THREE.RGBAFormat, generateMipmaps: true, needsUpdate: true });
  return out;
}

function brightness(face, x, y) {
  if (face === '+z') return x % 8 < 3 && y % 4 < 3 ? 255 : 120;
  if (face === '-z') return 70;
  return 110 + 40 * Math.sin(x / SIDE * Math.PI);
}
