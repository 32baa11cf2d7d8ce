// SPDX-License-Identifier: Apache-2.0
// A storage unit's front, with the bin in which a person works lit.

import { get } from '../base/api.js';
import { tr } from '../language/texts.js';
import { within } from '../base/world.js';

const SIDE = 0.8, TOP = 1.8; // of a storage unit [m]
const SCALE = 250; // of its drawing [px/m]
const RETRY = 3000; // after no answer [ms]

/** The drawing of the unit that is at a station. */
export class UnitDrawing {
  constructor(svg) {
    Object.assign(this, { svg, unit: 0, bins: [], asked: 0, shown: '' });
    svg.setAttribute('viewBox', `${-SCALE * SIDE / 2 - 4} ${-SCALE * TOP - 4} ${SCALE * SIDE + 8} ${SCALE * TOP + 8}`);
  }

  /** Lights a bin of a unit, with a number of pieces. Its bins follow when the server has sent them. */
  show(unit, lit, quantity) {
    if (unit !== this.unit) {
      Object.assign(this, { unit, bins: [] });
      this.learn(unit);
    }
    Object.assign(this, { lit, quantity });
    this.draw();
  }

  /** Asks for the unit's bins, and once more later if no answer comes. */
  async learn(unit) {
    const bins = await binsOf(unit).catch(() => null);
    if (unit !== this.unit) return;
    this.bins = bins ?? [];
    if (bins) this.draw();
    else setTimeout(() => this.learn(unit), RETRY);
  }

  draw() {
    const { svg, unit, lit, quantity, bins } = this, shown = JSON.stringify([unit, lit, quantity, bins.length]);
    if (shown === this.shown) return;
    this.shown = shown;
    svg.setAttribute('aria-label', tr`Storage unit ${unit}, seen from its front; ${lit} is lit`);
    svg.innerHTML = front(bins, lit, quantity);
  }
}

/** The inside of an <svg>: a unit's front with its bins, one of which is lit. */
function front(bins, lit, quantity) {
  const draw = (className, x, y, width, height) => (
    `<rect class="${className}" x="${SCALE * (x - width / 2)}" y="${-SCALE * (y + height)}" width="${SCALE * width}" height="${SCALE * height}"/>`);
  const levels = [...new Set(bins.map(({ z }) => z))];
  const isLit = ({ name }) => name === lit;
  // The nearer ones last; the lit one on top.
  const order = [...bins].sort((a, b) => isLit(a) - isLit(b) || a.depth - b.depth);
  const [first] = order.filter(isLit);
  return draw('', 0, 0, SIDE, TOP) + levels.map((z) => draw('plate', 0, z - 0.04, SIDE, 0.02)).join('')
    + order.map((bin) => draw(isLit(bin) ? 'bin lit' : 'bin', bin.x, bin.z - 0.02, 0.16, 0.22)).join('')
    + (first ? `<text x="${SCALE * first.x}" y="${-SCALE * (first.z + 0.09)}">${quantity}</text>` : '');
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
