// SPDX-License-Identifier: Apache-2.0
// The figures of a shift: four large ones with their last hour and their target, the rest small.

import { sparkline } from '../base/charts.js';
import { $, make } from '../base/dom.js';
import { number, percent as share } from '../language/numbers.js';
import { tr } from '../language/texts.js';

export const count = (value) => number(value);
const percent = (value) => share(value);
const exact = (value) => share(value, value < 0.1 ? 1 : 0);

/** What the server calls each; `most`: less is better. */
const LEADING = [
  { name: 'pieces', title: tr`Pieces per hour`, format: count, aim: ({ target, of }) => tr`target ${count(target)}: 90 % of what stations can, ${count(of)}` },
  { name: 'orders', title: tr`Orders done per hour`, format: count, aim: ({ target }) => (target ? tr`target ${count(target)}: as many arrive` : tr`target: as many as come in`) },
  { name: 'late', title: tr`Late orders`, format: exact, most: true, aim: ({ target }) => tr`target ${percent(target)} at most` },
  { name: 'available', title: tr`Robots available`, format: percent, aim: ({ target, of, value }) => tr`${count(of * value)} of ${count(of)}; target ${percent(target)} at least` },
];
const SMALL = [
  ['orders_completed', tr`orders completed`, count],
  ['orders_waiting', tr`orders waiting`, count],
  ['orders_at_stations', tr`orders at stations`, count],
  ['orders_late', tr`orders late now`, count],
  ['pile_on', tr`pieces per unit visit`, (v) => number(v, 1)],
  ['station_idle_fraction', tr`picking stations idle`, percent],
  ['stock_level', tr`stock`, percent],
  ['real_time_factor', tr`real-time factor`, (v) => number(v, 2)],
  ['collisions', tr`collisions`, count],
];
const EXACT = 0.02; // of the target: as good as met
const NEAR = 0.1; // the same: missed by little

/** 'good', 'near' or 'missed', and the word for it; '' where there is no target, or it is too early to
 *  miss it. `enough`: all is done that there is to do. */
export function verdict({ value, target, early = false, enough = false }, most = false) {
  if (!target) return ['', ''];
  const miss = most ? value - target : (target - value) / target;
  if (miss <= (most ? 0 : EXACT)) return ['good', tr`on target`];
  if (early) return ['', tr`the shift begins`];
  if (enough) return ['good', tr`all that is ordered`];
  return most ? above(miss, target) : below(miss);
}

const above = (miss, target) => (miss <= target ? ['near', tr`just above target`] : ['missed', tr`above target`]);
const below = (miss) => (miss <= NEAR ? ['near', tr`just below target`] : ['missed', tr`below target`]);

const COLOURS = { good: 'working', near: 'waiting', missed: 'needs-help', '': 'moving' };

class Card {
  constructor(about) {
    this.about = about;
    this.value = make('b', { className: 'value' });
    this.badge = make('span', { className: 'badge' });
    this.aim = make('p', { className: 'aim dim' });
    const canvas = make('canvas');
    canvas.setAttribute('role', 'img');
    canvas.ariaLabel = tr`${about.title}, over the last hour`;
    this.canvas = canvas;
    this.line = sparkline(canvas, () => COLOURS[this.state ?? '']);
    this.element = make('article', { className: 'card figure' }, make('header', {}, make('h2', { textContent: about.title }), this.badge),
      this.value, make('div', { className: 'spark' }, canvas), this.aim);
    this.element.dataset.figure = about.name;
  }

  show(figure) {
    const { about } = this, { times, values, target } = figure;
    const [state, word] = verdict(figure, about.most);
    this.value.textContent = about.format(figure.value);
    this.badge.className = `badge ${COLOURS[state]}`;
    Object.assign(this.badge, { textContent: word, hidden: !word });
    this.aim.textContent = about.aim(figure);
    const points = times.map((x, i) => ({ x, y: values[i] }));
    const ends = times.length > 1 && target ? [{ x: times[0], y: target }, { x: times.at(-1), y: target }] : [];
    if (values.length) this.canvas.ariaLabel = tr`${about.title}, over the last hour: from ${about.format(Math.min(...values))} to ${about.format(Math.max(...values))}`;
    this.line.show(points, ends);
    if (state !== this.state) {
      this.state = state;
      this.line.restyle();
    }
  }
}

export class Figures {
  constructor() {
    this.cards = LEADING.map((about) => new Card(about));
    $('leading').replaceChildren(...this.cards.map(({ element }) => element));
  }

  showLeading(figures) {
    for (const card of this.cards) card.show(figures[card.about.name]);
  }

  showSmall(kpis) {
    $('figures').replaceChildren(...SMALL.map(([name, text, format]) => (
      make('div', {}, make('dt', { textContent: text }), make('dd', { textContent: format(kpis[name]) })))));
  }
}
