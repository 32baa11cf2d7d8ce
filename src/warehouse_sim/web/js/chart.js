// SPDX-License-Identifier: Apache-2.0
// The throughput of the last hour.

import { $ } from './dom.js';

const WIDTH = 600, HEIGHT = 150, MOST = 60; // [px], intervals
const PARTIAL = 15; // of an interval that goes on less has no rate yet [s]

/** {from, length, rate} of each interval: seconds from the first one on, and pieces an hour. */
export function ratesOf({ interval, begin, end }, counts) {
  return counts.map((count, i) => {
    const from = Math.max(begin, (Math.floor(begin / interval) + i) * interval);
    const to = (Math.floor(begin / interval) + i + 1) * interval;
    const length = Math.min(to, end) - from;
    return { from: from - begin, length, rate: length >= Math.min(PARTIAL, interval) ? 3600 * count / length : null };
  }).filter(({ rate }) => rate !== null);
}

/** `throughput` as the server tells it, and the upper bound [1/h]. */
export function draw(throughput, bound) {
  const picked = ratesOf(throughput, throughput.items_picked);
  const stored = ratesOf(throughput, throughput.pieces_stored);
  const top = 1.15 * Math.max(bound, 1, ...picked.map(({ rate }) => rate), ...stored.map(({ rate }) => rate));
  const span = MOST * throughput.interval;
  const last = picked.at(-1) ? picked.at(-1).from + picked.at(-1).length : 0;
  const x = (time) => (WIDTH * (1 - (last - time) / span)).toFixed(1);
  const y = (rate) => (HEIGHT * (1 - rate / top)).toFixed(1);
  const bars = picked.map(({ from, length, rate }) => (
    `<rect x="${x(from)}" y="${y(rate)}" width="${(0.85 * WIDTH * length / span).toFixed(1)}" height="${(HEIGHT * rate / top).toFixed(1)}"/>`));
  const line = stored.map(({ from, length, rate }) => `${x(from + length / 2)},${y(rate)}`);
  $('chart').innerHTML = `${bars.join('')}<polyline points="${line.join(' ')}"/>
    <line x1="0" x2="${WIDTH}" y1="${y(bound)}" y2="${y(bound)}"/>`;
  $('chart-bound').textContent = `upper bound ${Math.round(bound).toLocaleString('en')}`;
  $('chart-bound').style.top = `${100 * (1 - bound / top)}%`;
  $('chart-begin').textContent = '1 hour ago';
}
