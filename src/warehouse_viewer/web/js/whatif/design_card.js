// SPDX-License-Identifier: Apache-2.0
// A search in the list: its progress, and the front that it found.

import { make } from '../base/dom.js';
import { ROOT } from '../base/root.js';
import { tr } from '../language/texts.js';
import { describeDesign } from './design_words.js';
import { BADGES, duration, interval, layoutOf, number } from './words.js';

const HEADS = [tr`Layout`, tr`To buy`, tr`A piece`, tr`On days not seen`, tr`Late`, tr`Robots`, tr`Stations`, tr`Units`];
const BADGE = { ...BADGES, waits: ['resting', tr`waits`], cut: ['waiting', tr`cut off`] };

export const pathOfDesign = (name, rest = '') => `/designs/${encodeURIComponent(name)}${rest}`;

export class DesignCard {
  /** act: {run, cancel, remove, again, use(name, layout)}. */
  constructor(name, act) {
    Object.assign(this, { name, act });
    const button = (text, what, className = 'edged') => make('button', { textContent: text, className, click: () => act[what](name), ariaLabel: `${text} ${name}` });
    this.badge = make('span', { className: 'badge' });
    this.about = make('p', { className: 'dim about' });
    this.bar = make('progress', { max: 1, ariaLabel: tr`Progress of ${name}` });
    this.left = make('span', { className: 'dim number' });
    this.progress = make('div', { className: 'progress' }, this.bar, this.left);
    this.trouble = make('p', { className: 'answer' });
    this.trouble.dataset.kind = 'refused';
    this.answer = make('p', { className: 'found' });
    this.front = make('div', { className: 'front', role: 'region', ariaLabel: tr`Layouts that ${name} found`, tabIndex: 0 });
    this.plans = make('div', { className: 'plans' });
    this.report = make('a', { className: 'button edged', href: `${ROOT}/whatif${pathOfDesign(name, '/report.html')}`, target: '_blank', rel: 'noopener', textContent: tr`Report`, ariaLabel: tr`Report ${name}` });
    this.buttons = { run: button(tr`Go on`, 'run', 'strong'), cancel: button(tr`Cancel`, 'cancel'), again: button(tr`Another like it`, 'again'), remove: button(tr`Delete`, 'remove') };
    this.element = make('li', { className: 'card scenario' },
      make('div', { className: 'card-head' }, make('h3', { textContent: name }), this.badge),
      this.about, this.progress, this.trouble, this.answer, this.front, this.plans,
      make('div', { className: 'card-buttons' }, this.report, ...Object.values(this.buttons)));
    this.element.dataset.design = name;
  }

  update(design) {
    const text = JSON.stringify(design);
    if (text === this.shown) return;
    this.shown = text;
    const { state, answer, front, settings } = design;
    const [kind, words] = BADGE[state];
    Object.assign(this.badge, { className: `badge ${kind}`, textContent: words });
    this.about.textContent = settings ? describeDesign(settings) : '';
    this.trouble.textContent = design.error ?? '';
    this.trouble.hidden = !design.error;
    this.answer.textContent = answer ? `${answer.text} ${answer.effort}` : '';
    this.answer.hidden = !answer;
    this.report.hidden = !answer;
    this.showProgress(design);
    this.showFront(front);
    const isBusy = state === 'runs' || state === 'waits';
    this.buttons.run.hidden = isBusy || state === 'done' || state === 'wrong';
    this.buttons.run.textContent = state === 'none' ? tr`Run` : tr`Go on`;
    this.buttons.cancel.hidden = !isBusy;
    this.buttons.again.hidden = state === 'wrong';
  }

  showProgress({ state, share = 0, stage = '', left }) {
    this.progress.hidden = state === 'done' || state === 'wrong';
    this.bar.hidden = state !== 'runs';
    this.bar.value = share;
    const begins = stage || tr`begins`;
    this.left.textContent = state === 'runs' ? tr`${begins}, about ${duration(left)} left` : tr`takes about ${duration(left)}`;
  }

  showFront(front) {
    this.front.hidden = this.plans.hidden = !front.length;
    if (!front.length) return;
    const head = make('tr', {}, ...HEADS.map((text) => make('th', { scope: 'col', textContent: text })));
    this.front.replaceChildren(make('table', {}, make('thead', {}, head), make('tbody', {}, ...front.map((row) => this.row(row)))));
    this.plans.replaceChildren(...front.map(({ layout }) => this.plan(layout)));
  }

  row(row) {
    const cells = [number(row.to_buy), number(row.a_piece, 4), `${interval({ mean: row.unseen_a_piece, half: row.unseen_a_piece_half }, 4)}`,
      `${number(row.late, 2)} %`, number(row.robots), row.replenishing ? `${row.stations} + ${row.replenishing}` : number(row.stations), number(row.units)];
    return make('tr', {}, make('th', { scope: 'row', textContent: layoutOf(row.layout) }), ...cells.map((textContent) => make('td', { className: 'number', textContent })));
  }

  plan(layout) {
    const name = layoutOf(layout), of = (text) => `${text} ${name}, ${this.name}`;
    const file = pathOfDesign(this.name, `/layouts/${encodeURIComponent(layout)}`);
    const edit = `${ROOT}/layout?design=${encodeURIComponent(this.name)}&layout=${encodeURIComponent(layout)}`;
    return make('figure', {}, make('img', { src: `${ROOT}/whatif${file}/plan.svg`, alt: of(tr`Plan of`), loading: 'lazy' }),
      make('figcaption', {}, `${name} `, make('a', { href: edit, textContent: tr`edit`, ariaLabel: of('edit') }), ' ',
        make('a', { href: `${ROOT}/whatif${file}`, download: layout, textContent: tr`file`, ariaLabel: of('download') }), ' ',
        make('button', { className: 'text-button', textContent: tr`as a scenario`, ariaLabel: of(tr`make a scenario of`), click: () => this.act.use(this.name, layout) })));
  }
}
