// SPDX-License-Identifier: Apache-2.0
// Hooks of setup.mjs.

const THREE = 'file:///usr/share/javascript/three/';
const PAGE = new URL('../../../src/warehouse_viewer/web/', import.meta.url).href;

export function resolve(specifier, context, next) {
  return next(specifier.startsWith('/three/') ? THREE + specifier.slice('/three/'.length) : specifier, context);
}

/** In a browser each of them is a module, whatever its suffix. */
export function load(url, context, next) {
  const isModule = url.startsWith(THREE) || url.startsWith(PAGE);
  return next(url, isModule ? { ...context, format: 'module' } : context);
}
