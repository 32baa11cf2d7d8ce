// SPDX-License-Identifier: Apache-2.0
// Bars with their confidence intervals.

import { token } from '../base/dom.js';

const CAP = 7; // half a whisker's cap [px]

/** A unit behind a title: 'an hour' goes on with its words. */
export const unitOf = (unit) => (unit.startsWith('an ') ? unit : `[${unit}]`);

/** What is drawn of a row of figures: {labels, means, ranges, axis, digits}. */
export function chartOf(names, { title, unit, digits, cells }) {
  return {
    labels: names,
    means: cells.map(({ mean }) => mean),
    ranges: cells.map(({ mean, half }) => (half === null ? null : [Math.max(mean - half, 0), mean + half])),
    axis: `${title} ${unitOf(unit)}`,
    digits,
  };
}

/** The least end of an axis from zero that shows all means and intervals. */
export function topOf({ means, ranges }) {
  return Math.max(1e-9, ...means, ...ranges.map((range) => range?.[1] ?? 0)) * 1.08;
}

const whiskers = {
  id: 'whiskers',
  afterDatasetsDraw(chart, _, { ranges, colour }) {
    const { ctx: pen, scales: { y } } = chart;
    pen.save();
    Object.assign(pen, { strokeStyle: colour, lineWidth: 2 });
    chart.getDatasetMeta(0).data.forEach((bar, i) => {
      if (!ranges[i]) return;
      const [low, high] = ranges[i].map((value) => y.getPixelForValue(value));
      pen.beginPath();
      for (const at of [low, high]) {
        pen.moveTo(bar.x - CAP, at);
        pen.lineTo(bar.x + CAP, at);
      }
      pen.moveTo(bar.x, low);
      pen.lineTo(bar.x, high);
      pen.stroke();
    });
    pen.restore();
  },
};

/** Draws into a canvas, in place of a chart that was there; returns the chart. */
export function draw(canvas, shown, before) {
  before?.destroy();
  const text = { color: token('dim'), font: { family: 'Inter, sans-serif', size: 12 } };
  const grid = { color: token('line'), drawBorder: false };
  return new window.Chart(canvas, {
    type: 'bar',
    data: { labels: shown.labels, datasets: [{ data: shown.means, backgroundColor: shown.means.map((_, i) => token(i ? 'moving' : 'resting')), maxBarThickness: 90, borderRadius: 4 }] },
    options: {
      animation: false,
      maintainAspectRatio: false,
      scales: {
        x: { ticks: text, grid: { display: false, drawBorder: false } },
        y: { beginAtZero: true, max: topOf(shown), ticks: { ...text, maxTicksLimit: 6, includeBounds: false }, grid, title: { display: true, text: shown.axis, ...text } },
      },
      plugins: { legend: { display: false }, whiskers: { ranges: shown.ranges, colour: token('text') } },
    },
    plugins: [whiskers],
  });
}
