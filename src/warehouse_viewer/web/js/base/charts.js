// SPDX-License-Identifier: Apache-2.0
// Charts by Chart.js, in the colours and the type of the design. The library comes when the first
// chart is wanted.

import { make, on, onTheme, token } from './dom.js';
import { tr } from '../language/texts.js';

const LIBRARY = '/chart/chart.min.js';
let loading = null;
const plots = new Set();

/** A token's colour with an opacity of 0 to 1. */
export function faint(name, opacity) {
  const [r, g, b] = token(name).match(/[\da-f]{2}/gi).map((part) => parseInt(part, 16));
  return `rgba(${r}, ${g}, ${b}, ${opacity})`;
}

function library() {
  loading ??= new Promise((resolve, reject) => {
    const script = make('script', { src: LIBRARY });
    on(script, 'load', () => resolve(window.Chart));
    on(script, 'error', () => reject(new Error(tr`there is no Chart.js: is libjs-chart.js installed?`)));
    document.head.append(script);
  });
  return loading;
}

/** A chart on a canvas. `look()` returns its {type, datasets, options} in the current colours; data come
 *  by show(). */
export class Plot {
  constructor(canvas, look) {
    Object.assign(this, { canvas, look, chart: null, data: null });
    if (!plots.size) onTheme(restyle);
    plots.add(this);
  }

  /** Draws a list of points for each dataset. */
  async show(...data) {
    this.data = data;
    if (this.chart) this.draw();
    else if (!this.isComing) {
      this.isComing = true;
      const Chart = await library().catch((error) => {
        this.canvas.replaceWith(make('p', { className: 'dim', textContent: error.message }));
      });
      if (Chart) this.begin(Chart);
    }
  }

  begin(Chart) {
    this.chart = new Chart(this.canvas, { ...this.config(), type: this.look().type });
    this.draw();
  }

  config() {
    const { datasets, options } = this.look();
    return { data: { datasets: datasets.map((dataset, i) => ({ ...dataset, data: this.data[i] ?? [] })) },
      options: { animation: false, responsive: true, maintainAspectRatio: false, events: ['mousemove', 'mouseout', 'touchstart'], ...options } };
  }

  draw() {
    this.data.forEach((points, i) => { this.chart.data.datasets[i].data = points; });
    this.chart.update('none');
  }

  /** Takes over the colours of now. */
  restyle() {
    if (!this.chart) return;
    Object.assign(this.chart.options, this.config().options);
    this.look().datasets.forEach((dataset, i) => Object.assign(this.chart.data.datasets[i], dataset));
    this.chart.update('none');
  }
}

function restyle() {
  for (const plot of plots) plot.restyle();
}

/** The options of an axis with a title that names the unit. */
export function axis(title, more = {}) {
  return {
    type: 'linear',
    title: { display: Boolean(title), text: title, color: token('dim'), font: font() },
    ticks: { color: token('dim'), font: font(), maxTicksLimit: 6, ...more.ticks },
    grid: { color: token('line'), drawBorder: false, ...more.grid },
    ...more.scale,
  };
}

export function font(size = 12) {
  return { family: 'Inter, system-ui, sans-serif', size };
}

/** A line without axes over the last hour, with a dashed one at the target. */
export function sparkline(canvas, colour) {
  const bare = { display: false };
  return new Plot(canvas, () => ({
    type: 'line',
    datasets: [
      { borderColor: token(colour()), backgroundColor: faint(colour(), 0.14), fill: 'start', borderWidth: 1.75, pointRadius: 0, tension: 0.25 },
      { borderColor: token('dim'), borderWidth: 1, borderDash: [3, 3], pointRadius: 0 },
    ],
    options: {
      parsing: false, layout: { padding: { top: 2, bottom: 2 } },
      scales: { x: { type: 'linear', bounds: 'data', ...bare }, y: { type: 'linear', beginAtZero: true, grace: '8%', ...bare } },
      plugins: { legend: bare, tooltip: { enabled: false } },
    },
  }));
}
