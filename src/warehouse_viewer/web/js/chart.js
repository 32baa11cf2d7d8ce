// SPDX-License-Identifier: Apache-2.0
// The throughput of the last hour: what was picked, beside the upper bound that holds for it, and
// below it, by a scale of its own, what was put in.

import { $, make } from './dom.js';

const WIDTH = 600, HEIGHT = 150, MOST = 60; // [px], intervals
const PARTIAL = 15; // of an interval that goes on less has no rate yet [s]
const TICKS = 5, FEW = 2; // of an axis, at most; of a low one

/** {from, length, rate} of each interval: seconds from the first one on, and pieces an hour. */
export function ratesOf({ interval, begin, end }, counts) {
  return counts.map((count, i) => {
    const from = Math.max(begin, (Math.floor(begin / interval) + i) * interval);
    const to = (Math.floor(begin / interval) + i + 1) * interval;
    const length = Math.min(to, end) - from;
    return { from: from - begin, length, rate: length >= Math.min(PARTIAL, interval) ? 3600 * count / length : null };
  }).filter(({ rate }) => rate !== null);
}

/** Round numbers from 0 up to `top`, for an axis. */
export function ticksOf(top, most = TICKS) {
  const power = 10 ** Math.floor(Math.log10(top / most));
  const step = [1, 2, 5, 10].map((n) => n * power).find((n) => top / n <= most);
  return Array.from({ length: Math.floor(top / step + 1e-9) + 1 }, (_, i) => i * step);
}

/** `throughput` as the server tells it, and the upper bound of what is picked [1/h]. */
export function draw(throughput, bound) {
  const span = MOST * throughput.interval;
  plot('picked', ratesOf(throughput, throughput.items_picked), span, TICKS, bound);
  plot('stored', ratesOf(throughput, throughput.pieces_stored), span, FEW);
}

/** Bars, their axis, and a line at the bound if there is one. */
function plot(name, rates, span, most, bound = 0) {
  const top = 1.15 * Math.max(bound, 1, ...rates.map(({ rate }) => rate));
  const last = rates.at(-1) ? rates.at(-1).from + rates.at(-1).length : 0;
  const ticks = ticksOf(top, most);
  const x = (time) => (WIDTH * (1 - (last - time) / span)).toFixed(1);
  const y = (rate) => (HEIGHT * (1 - rate / top)).toFixed(1);
  const across = (className, rate) => `<line class="${className}" x1="0" x2="${WIDTH}" y1="${y(rate)}" y2="${y(rate)}"/>`;
  const bars = rates.map(({ from, length, rate }) => (
    `<rect x="${x(from)}" y="${y(rate)}" width="${(0.85 * WIDTH * length / span).toFixed(1)}" height="${(HEIGHT * rate / top).toFixed(1)}"/>`));
  $(`chart-${name}`).innerHTML = ticks.map((tick) => across('tick', tick)).join('') + bars.join('')
    + (bound ? across('bound', bound) : '');
  $(`axis-${name}`).replaceChildren(...ticks.map((tick) => at(tick / top, tick)));
  $(`bound-${name}`)?.replaceChildren(...bound ? [at(bound / top, `upper bound ${number(bound)}`)] : []);
}

/** A label at that part of the height. */
function at(part, value) {
  const out = make('span', { textContent: typeof value === 'number' ? number(value) : value });
  out.style.top = `${100 * (1 - part)}%`;
  return out;
}

function number(value) {
  return value.toLocaleString('en', { maximumFractionDigits: value < 10 ? 1 : 0 });
}
