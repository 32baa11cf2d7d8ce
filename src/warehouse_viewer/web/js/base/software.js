// SPDX-License-Identifier: Apache-2.0
// Whether the processor draws, for want of a graphics card: then it matters how, and how often. An address
// with ?picture=fine is drawn as by a card.

let known;

export function drawsInSoftware() {
  known ??= ask();
  return known;
}

function ask() {
  if (typeof document === 'undefined') return false; // no browser draws
  if (/[?&]picture=fine\b/.test(location.search)) return false;
  const gl = document.createElement('canvas').getContext('webgl');
  const debug = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = debug ? gl.getParameter(debug.UNMASKED_RENDERER_WEBGL) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}
