// SPDX-License-Identifier: Apache-2.0
// A storage unit's front, with the bin in which a person works lit.

import { get } from './api.js';
import { within } from './world.js';

const SIDE = 0.8, TOP = 1.8; // of a storage unit [m]
const SCALE = 250; // of its drawing [px/m]
const SVG = 'http://www.w3.org/2000/svg';

/** An <svg> of a unit's front; its bins follow when the server has told them. */
export function unitDrawing(unit, lit, quantity) {
  const svg = document.createElementNS(SVG, 'svg');
  drawUnit(svg, unit, lit, quantity);
  return svg;
}

/** The unit's front with its bins, of which one is lit. */
async function drawUnit(svg, unit, lit, quantity) {
  svg.setAttribute('class', 'shelf');
  svg.setAttribute('viewBox', `${-SCALE * SIDE / 2 - 4} ${-SCALE * TOP - 4} ${SCALE * SIDE + 8} ${SCALE * TOP + 8}`);
  svg.setAttribute('aria-label', `storage unit ${unit}, ${lit} is lit`);
  const bins = await binsOf(unit).catch(() => []);
  const draw = (className, x, y, width, height) => (
    `<rect class="${className}" x="${SCALE * (x - width / 2)}" y="${-SCALE * (y + height)}" width="${SCALE * width}" height="${SCALE * height}"/>`);
  const levels = [...new Set(bins.map(({ z }) => z))];
  const isLit = ({ name }) => name === lit;
  // The nearer ones last; the lit one on top.
  const order = bins.sort((a, b) => isLit(a) - isLit(b) || a.depth - b.depth);
  const [one] = order.filter(isLit);
  svg.innerHTML = draw('', 0, 0, SIDE, TOP) + levels.map((z) => draw('plate', 0, z - 0.04, SIDE, 0.02)).join('')
    + order.map((bin) => draw(isLit(bin) ? 'bin lit' : 'bin', bin.x, bin.z - 0.02, 0.16, 0.22)).join('')
    + (one ? `<text x="${SCALE * one.x}" y="${-SCALE * (one.z + 0.09)}">${quantity}</text>` : '');
}

/** [{name, x, z, depth}] of a unit's bins, in its own frame [m], seen from its front. */
async function binsOf(unit) {
  const [place, { things }] = await Promise.all([
    get(`/storage_units/${unit}`), get(`/items?limit=100&storage_unit=storage_unit${unit}`)]);
  const frame = planarOf(place.pose);
  const back = within([0, 0, 0, -frame[3]], [-frame[0], -frame[1], -frame[2], 0]);
  return things.map(({ name, pose }) => {
    const [depth, x, z] = within([...back.slice(0, 3), -frame[3]], planarOf(pose));
    return { name, x, z: Math.round(100 * z) / 100, depth };
  });
}

function planarOf({ x, y, z, qx, qy, qz, qw }) {
  return [x, y, z, Math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))];
}
