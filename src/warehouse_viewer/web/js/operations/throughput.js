// SPDX-License-Identifier: Apache-2.0
// The throughput of the last hour: what was picked and put in, beside the upper bound that holds.

import { axis, faint, font, Plot } from '../base/charts.js';
import { $, token } from '../base/dom.js';
import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';

const PARTIAL = 15; // shortest part of the present interval that has a rate [s]
const HOUR = 60; // [min]
const SMOOTHED = 5; // intervals

/** {from, length, rate} of each interval: seconds from the first one on, and pieces an hour. */
export function ratesOf({ interval, begin, end }, counts) {
  return counts.map((count, i) => {
    const from = Math.max(begin, (Math.floor(begin / interval) + i) * interval);
    const to = (Math.floor(begin / interval) + i + 1) * interval;
    const length = Math.min(to, end) - from;
    return { from: from - begin, length, rate: length >= Math.min(PARTIAL, interval) ? 3600 * count / length : null };
  }).filter(({ rate }) => rate !== null);
}

/** Points of rates, x in minutes before the end. */
export function pointsOf(throughput, counts) {
  const rates = ratesOf(throughput, counts), last = rates.at(-1);
  const end = last ? last.from + last.length : 0;
  return rates.map(({ from, length, rate }) => ({ x: (from + length / 2 - end) / 60, y: Math.round(rate) }));
}

/** Each point the mean of the last five: bundles come by the dozen. */
export function smoothed(points) {
  return points.map(({ x }, i) => {
    const some = points.slice(Math.max(0, i + 1 - SMOOTHED), i + 1);
    return { x, y: some.reduce((sum, { y }) => sum + y, 0) / some.length };
  });
}

export class ThroughputChart {
  constructor() {
    this.plot = new Plot($('chart-throughput'), look);
  }

  /** `throughput` from the server, and the upper bound of what is picked [1/h]. */
  show(throughput, bound) {
    const picked = pointsOf(throughput, throughput.items_picked);
    const stored = smoothed(pointsOf(throughput, throughput.pieces_stored));
    const line = bound ? [{ x: -HOUR, y: bound }, { x: 0, y: bound }] : [];
    $('chart-throughput').ariaLabel = tr`Pieces per hour, over the last hour; in the last minute ${picked.at(-1)?.y ?? 0} `
      + tr`picked and ${Math.round(stored.at(-1)?.y ?? 0)} put in; the upper bound is ${Math.round(bound)}`;
    return this.plot.show(picked, stored, line);
  }
}

function look() {
  return {
    type: 'bar',
    datasets: [
      { label: tr`picked`, backgroundColor: token('moving'), borderRadius: 2, categoryPercentage: 1, barPercentage: 0.8, maxBarThickness: 12 },
      { type: 'line', label: tr`put in`, yAxisID: 'stored', borderColor: token('working'), backgroundColor: faint('working', 0.2), borderWidth: 1.5, pointRadius: 0, tension: 0.2 },
      { type: 'line', label: tr`upper bound`, borderColor: token('dim'), borderDash: [4, 4], borderWidth: 1.25, pointRadius: 0 },
    ],
    options: {
      interaction: { mode: 'nearest', axis: 'x', intersect: false },
      scales: {
        x: axis(tr`minutes ago`, { ticks: { stepSize: 15, callback: (minutes) => (minutes ? -minutes : tr`now`) }, grid: { display: false }, scale: { min: -HOUR, max: 0, offset: false } }),
        y: axis(tr`pieces per hour`, { ticks: { callback: (rate) => number(rate) }, scale: { beginAtZero: true, grace: '5%' } }),
        // Bundles are many pieces at once: upon one scale they would press what is picked to the floor.
        stored: axis(tr`put in per hour`, { ticks: { callback: (rate) => number(rate) }, grid: { display: false }, scale: { position: 'right', beginAtZero: true, suggestedMax: 10, grace: '5%' } }),
      },
      plugins: {
        legend: { display: false },
        tooltip: { backgroundColor: token('raised'), titleColor: token('text'), bodyColor: token('text'), borderColor: token('line'), borderWidth: 1, titleFont: font(), bodyFont: font(),
          callbacks: { title: ([{ parsed }]) => tr`${Math.max(0, Math.round(-parsed.x))} min ago`, label: ({ dataset, parsed }) => ` ${dataset.label}: ${number(parsed.y)}` } },
      },
    },
  };
}
