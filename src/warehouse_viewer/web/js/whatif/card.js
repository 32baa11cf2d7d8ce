// SPDX-License-Identifier: Apache-2.0
// A scenario in the list. Its elements stay while what they say changes, and so does the focus.

import { make } from '../base/dom.js';
import { ROOT } from '../base/root.js';
import { tr } from '../language/texts.js';
import { pathOf } from './server.js';
import { BADGES, describe, duration, interval, limitOf, runsOf } from './words.js';

const FIGURES = [['pieces', tr`pieces an hour`, 0, ''], ['share', tr`of what stations can`, 0, ' %'], ['late', tr`orders late`, 1, ' %'], ['waiting', tr`robots wait`, 0, ' %']];
const REASONS = { failed: tr`failed`, cut: tr`cut off when the server ended`, cancelled: tr`cancelled` };

export class Card {
  /** `act`: {run, cancel, change, duplicate, rename, remove, pick}, each called with the name. */
  constructor(name, act) {
    this.name = name;
    const call = (what) => () => act[what](this.name);
    const button = (text, what, className = 'edged') => make('button', { textContent: text, className, click: call(what), ariaLabel: `${text} ${name}` });
    this.pick = make('input', { type: 'checkbox', id: `pick-${CSS.escape(name)}`, click: call('pick') });
    this.badge = make('span', { className: 'badge' });
    this.about = make('p', { className: 'dim about' });
    this.figures = make('div', { className: 'figures' });
    this.bar = make('progress', { max: 1, ariaLabel: tr`Progress of ${name}` });
    this.left = make('span', { className: 'dim number' });
    this.progress = make('div', { className: 'progress' }, this.bar, this.left);
    this.trouble = make('p', { className: 'answer' });
    this.trouble.dataset.kind = 'refused';
    this.buttons = {
      run: button(tr`Run`, 'run', 'strong'), cancel: button(tr`Cancel`, 'cancel'), change: button(tr`Change`, 'change'),
      duplicate: button(tr`Duplicate`, 'duplicate'), rename: button(tr`Rename`, 'rename'), remove: button(tr`Delete`, 'remove'),
    };
    this.runs = make('ul', { className: 'runs' });
    this.details = make('details', {}, make('summary', { textContent: tr`Runs and reports` }), this.runs);
    this.element = make('li', { className: 'card scenario' },
      make('div', { className: 'card-head' }, make('label', { className: 'pick' }, this.pick, make('h3', { textContent: name })), this.badge),
      this.about, this.figures, this.progress, this.trouble,
      make('div', { className: 'card-buttons' }, ...Object.values(this.buttons)), this.details);
    this.element.dataset.name = name;
  }

  update(scenario, isPicked) {
    this.pick.checked = isPicked;
    this.element.classList.toggle('picked', isPicked);
    this.pick.title = tr`Compare`;
    const text = JSON.stringify(scenario);
    if (text === this.shown) return;
    this.shown = text;
    this.scenario = scenario;
    const [kind, words] = BADGES[scenario.state];
    Object.assign(this.badge, { className: `badge ${kind}`, textContent: words });
    this.about.textContent = scenario.settings ? describe(scenario.settings, scenario.site) : '';
    this.showFigures(scenario.summary);
    this.showProgress(scenario);
    this.showTrouble(scenario);
    this.showRuns(scenario);
    const runs = scenario.state === 'runs', isWhole = scenario.state === 'done';
    this.buttons.run.hidden = runs || isWhole || scenario.state === 'wrong';
    this.buttons.run.textContent = scenario.state === 'none' ? tr`Run` : tr`Run what is missing`;
    this.buttons.cancel.hidden = !runs;
    this.buttons.change.hidden = this.buttons.duplicate.hidden = scenario.state === 'wrong';
    this.buttons.change.disabled = this.buttons.rename.disabled = runs;
    this.buttons.change.title = this.buttons.rename.title = runs ? tr`Its runs are under way: wait for them, or cancel them.` : '';
  }

  showFigures(summary) {
    this.figures.hidden = !summary;
    if (!summary) return;
    this.figures.replaceChildren(...FIGURES.map(([key, words, digits, unit]) => (
      make('div', {}, make('b', { className: 'number', textContent: interval(summary.figures[key], digits) + unit }), make('span', { className: 'dim', textContent: words })))),
    make('div', { className: 'limit' }, make('span', { className: 'dim', textContent: tr`limited by ${limitOf(summary.limit)}` })));
  }

  showProgress({ state, runs, left }) {
    const isShown = state === 'runs' || state === 'none' || state === 'part';
    this.progress.hidden = !isShown;
    this.bar.hidden = state !== 'runs';
    const done = runs.filter((run) => run.state === 'done').length;
    this.bar.value = runs.reduce((sum, run) => sum + (run.state === 'done' ? 1 : run.share ?? 0), 0) / Math.max(runs.length, 1);
    this.left.textContent = state === 'runs' ? tr`${done} of ${runsOf(runs.length)}, about ${duration(left)} of computing left`
      : tr`takes about ${duration(left)} of computing`;
  }

  showTrouble({ error, runs }) {
    const failed = runs.find((run) => run.state === 'failed');
    const faults = runs.flatMap((run) => (run.faults ?? []).map((fault) => tr`seed ${run.seed}: ${fault}`));
    this.trouble.textContent = error ?? (failed ? tr`Seed ${failed.seed}: ${failed.text}` : faults.join('; '));
    this.trouble.hidden = !this.trouble.textContent;
  }

  showRuns({ name, runs }) {
    this.details.hidden = runs.every((run) => run.state === 'none');
    this.runs.replaceChildren(...runs.map((run) => make('li', {}, tr`Seed ${run.seed}: `, ...reportOf(name, run))));
  }
}

function reportOf(name, run) {
  if (run.state === 'done') {
    return [make('a', { href: `${ROOT}/whatif${pathOf(name, `/seeds/${run.seed}/report.html`)}`, target: '_blank', rel: 'noopener', textContent: 'report' })];
  }
  if (run.state === 'runs') return [`${Math.floor(100 * run.share)} %`];
  return [REASONS[run.state] ?? (run.state === 'waits' ? tr`waits` : tr`not run yet`)];
}
