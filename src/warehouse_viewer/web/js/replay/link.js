// SPDX-License-Identifier: Apache-2.0
// Addresses of a moment: /#t=630.5 in seconds of simulated time, /#at=10:42 by the clock on the wall
// where it is known, else by that of the shift; with &see=kiva7 for what is selected, and &from= for
// where the camera is, what it looks at, and its zoom from above.

import { readClock } from '../base/time.js';

const DAY = 86400; // [s]

/** {t}, {clock} in seconds, or null where an address names no moment. */
export function momentOf(hash) {
  const [, name, text] = /^#?(t|at)=([^&]+)/.exec(hash) ?? [];
  if (name === 't') {
    const t = Number(text);
    return text.trim() && Number.isFinite(t) ? { t } : null;
  }
  const clock = name && readClock(text);
  return clock || clock === 0 ? { clock } : null;
}

/** The address of a moment [s, simulated] on the page at `href`, with the name of what is selected
 *  and a view {position, target, zoom} of the floor, if there are such. */
export function linkTo(href, t, { name, view } = {}) {
  const see = name ? `&see=${encodeURIComponent(name)}` : '';
  const numbers = view ? [...view.position, ...view.target, ...view.zoom ? [view.zoom] : []] : [];
  const from = view ? `&from=${numbers.map((n) => Math.round(100 * n) / 100).join()}` : '';
  return `${href.replace(/#.*/, '')}#t=${Math.round(10 * t) / 10}${see}${from}`;
}

/** {name, view} that an address has beside its moment; null for each that it has not. */
export function lookOf(hash) {
  const query = new URLSearchParams(hash.replace(/^#/, ''));
  const numbers = (query.get('from') ?? '').split(',').map((text) => (text ? Number(text) : NaN));
  const isView = [6, 7].includes(numbers.length) && numbers.every(Number.isFinite) && (numbers[6] ?? 1) > 0;
  const view = isView ? { position: numbers.slice(0, 3), target: numbers.slice(3, 6), zoom: numbers[6] ?? 0 } : null;
  return { name: query.get('see'), view };
}

/** The simulated time [s] of a moment, by the chunks of a recording, [{begin, end, wall}]. */
export function timeOf({ t, clock }, chunks) {
  if (t !== undefined) return t;
  const known = chunks.filter(({ wall }) => wall !== null);
  if (!known.length) return clock;
  // The last chunk that begins before that time of its day.
  const late = known.map((chunk) => ({ chunk, after: wrapped(clock - ofDay(chunk.wall)) }));
  const { chunk, after } = late.reduce((best, other) => (other.after < best.after ? other : best));
  return Math.min(chunk.begin + after * paceOf(chunk, known), chunk.end);
}

/** Simulated seconds a second on the wall in a chunk. */
function paceOf(chunk, known) {
  const next = known[known.indexOf(chunk) + 1];
  return next && next.wall > chunk.wall ? (next.begin - chunk.begin) / (next.wall - chunk.wall) : 1;
}

/** The time on the wall, seconds since 1970, at a simulated time [s]; null: it is not known. */
export function wallAt(time, chunks) {
  const known = chunks.filter(({ wall, begin }) => wall !== null && begin <= time + 1e-6);
  const chunk = known.at(-1);
  if (!chunk) return null;
  const all = chunks.filter(({ wall }) => wall !== null);
  return chunk.wall + (time - chunk.begin) / paceOf(chunk, all);
}

function ofDay(seconds) {
  const at = new Date(1000 * seconds);
  return 3600 * at.getHours() + 60 * at.getMinutes() + at.getSeconds();
}

const wrapped = (seconds) => ((seconds % DAY) + DAY) % DAY;
