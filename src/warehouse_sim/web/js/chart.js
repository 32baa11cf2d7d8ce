// SPDX-License-Identifier: Apache-2.0
// The throughput of the last hour.

import { $ } from './dom.js';

const WIDTH = 600, HEIGHT = 150, MOST = 60; // [px], intervals
const ROOM = 0.8; // of the height: labels above have none
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

/** The smallest of 1, 2, 5, 10, 20, … of which `top` holds at most four: the step between the marks of an axis. */
export function stepOf(top) {
  const power = 10 ** Math.floor(Math.log10(top / 4));
  return power * [1, 2, 5, 10].find((factor) => factor * power * 4 >= top);
}

/** `throughput` as the server tells it, and the upper bound of picking [1/h]. What is put in has a chart of its own: the bound says nothing of it. */
export function draw(throughput, bound) {
  const length = MOST * throughput.interval;
  bars('chart', ratesOf(throughput, throughput.items_picked), length, bound);
  bars('chart-stored', ratesOf(throughput, throughput.pieces_stored), length, 0);
  $('chart-begin').textContent = '1 hour ago';
}

/** Rates as bars over the last `span` seconds, with an axis, and a line at the bound if there is one. */
function bars(name, rates, span, bound) {
  const top = 1.2 * Math.max(bound, 1, ...rates.map(({ rate }) => rate));
  const last = rates.at(-1) ? rates.at(-1).from + rates.at(-1).length : 0;
  const x = (time) => (WIDTH * (1 - (last - time) / span)).toFixed(1);
  const y = (rate) => (HEIGHT * (1 - rate / top)).toFixed(1);
  const across = (rate, kind) => `<line class="${kind}" x1="0" x2="${WIDTH}" y1="${y(rate)}" y2="${y(rate)}"/>`;
  const marks = Array.from({ length: Math.floor(ROOM * top / stepOf(top)) + 1 }, (_, i) => i * stepOf(top));
  $(name).innerHTML = marks.map((mark) => across(mark, 'mark')).join('') + rates.map(({ from, length, rate }) => (
    `<rect x="${x(from)}" y="${y(rate)}" width="${(0.85 * WIDTH * length / span).toFixed(1)}" height="${(HEIGHT * rate / top).toFixed(1)}"/>`
  )).join('') + (bound ? across(bound, 'bound') : '');
  $(`${name}-marks`).replaceChildren(...marks.map((mark) => label(mark, top, 'mark', mark.toLocaleString('en'))),
    ...bound ? [label(bound, top, 'bound', `upper bound of picking ${Math.round(bound).toLocaleString('en')}`)] : []);
}

function label(rate, top, kind, text) {
  const span = Object.assign(document.createElement('span'), { className: `${kind} dim`, textContent: text });
  span.style.top = `${100 * (1 - rate / top)}%`;
  return span;
}
