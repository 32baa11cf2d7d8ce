// SPDX-License-Identifier: Apache-2.0
// The page /whatif: scenarios, their runs, and how they compare.

import { reloadIfLockedOut } from '../base/api.js';
import { $, make, on } from '../base/dom.js';
import { ask as asked, confirmed } from '../base/question.js';
import { tr } from '../language/texts.js';
import { Notice } from './notice.js';
import { Card } from './card.js';
import { Comparison } from './comparison.js';
import { Designs } from './designs.js';
import { Form } from './form.js';
import { FromNow } from './from_now.js';
import { Intro, named } from './intro.js';
import { Picks } from './picks.js';
import { ask, pathOf, queryOf } from './server.js';
import { duration, runsOf } from './words.js';

const SOON = 1000, LATER = 5000; // interval between requests for scenarios, while some run and else [ms]
const MOST_FILE = 5e6; // [bytes]

class Page {
  constructor(about) {
    this.about = about;
    this.cards = new Map();
    this.scenarios = null;
    this.notice = new Notice($('told'));
    this.picks = new Picks(about.most.compared, () => this.showPicks());
    this.comparison = new Comparison((name) => this.picks.makeFirst(name));
    this.form = new Form(about, (...kept) => this.keep(...kept));
    this.intro = new Intro(about, (pairs) => this.start(pairs));
    this.designs = new Designs(this);
    this.fromNow = new FromNow();
    this.actions = this.makeActions();
    $('folder').textContent = tr`Kept in ${about.folder}`;
    $('draw-one').hidden = false;
    on($('new'), 'click', () => this.form.open(about.defaults, { taken: this.names }));
    this.showCosts();
    on($('costs-drop'), 'click', () => this.attempt(async () => {
      await ask('DELETE', '/costs');
      await this.takeCosts();
    }));
    on($('two'), 'click', () => this.showIntro(true));
    for (const button of document.querySelectorAll('[data-upload]')) on(button, 'click', () => this.openFile(button.dataset.upload));
    on($('upload'), 'change', () => this.attempt(() => this.upload($('upload').files)));
    on(document, 'visibilitychange', () => document.hidden || this.look());
    this.look();
  }

  get names() {
    return this.scenarios?.map(({ name }) => name) ?? [];
  }

  makeActions() {
    const send = (method, rest) => (name) => this.attempt(async () => {
      await ask(method, pathOf(name, rest));
      await this.look();
    });
    return {
      run: send('POST', '/run'),
      cancel: send('DELETE', '/run'),
      duplicate: (name) => this.attempt(() => this.duplicate(name)),
      change: (name) => this.change(name),
      rename: (name) => this.rename(name),
      remove: (name) => this.remove(name),
      pick: (name) => {
        if (!this.picks.toggle(name)) this.notice.say(tr`${this.about.most.compared} scenarios are compared at most; take one away first.`);
        this.showPicks();
      },
    };
  }

  // --- what the server sends
  /** Asks for all scenarios, and again after a while. */
  async look() {
    clearTimeout(this.timer);
    let pause = LATER;
    try {
      const answer = await ask('GET', '/scenarios');
      if (answer.running + answer.waiting) pause = SOON;
      this.show(answer);
    } catch (error) {
      this.showLink('away', error.message);
      reloadIfLockedOut();
    }
    clearTimeout(this.timer);
    this.timer = setTimeout(() => document.hidden || this.look(), pause);
  }

  show({ scenarios, designs, running, waiting, left }) {
    this.scenarios = scenarios;
    this.designs.show(designs);
    const text = running + waiting ? tr`${runsOf(running)} under way, ${waiting} waiting, about ${duration(left)} left` : tr`nothing runs`;
    this.showLink(running ? 'live' : 'idle', text);
    this.picks.keep(this.names);
    this.showCards();
    this.showIntro(this.wantsIntro);
    this.compare();
  }

  showLink(state, text) {
    $('link').dataset.state = state;
    if ($('link').textContent !== text) $('link').textContent = text;
  }

  showCards() {
    for (const [name, card] of this.cards) {
      if (this.names.includes(name)) continue;
      card.element.remove();
      this.cards.delete(name);
    }
    this.scenarios.forEach((scenario, i) => {
      if (!this.cards.has(scenario.name)) this.cards.set(scenario.name, new Card(scenario.name, this.actions));
      const card = this.cards.get(scenario.name);
      card.update(scenario, this.picks.has(scenario.name));
      if ($('list').children[i] !== card.element) $('list').insertBefore(card.element, $('list').children[i] ?? null);
    });
  }

  showPicks() {
    if (!this.scenarios) return;
    this.showCards();
    this.compare();
  }

  /** Two layouts are offered where there is nothing yet, or where a person asks for them. */
  showIntro(isWanted) {
    this.wantsIntro = isWanted;
    const isFirst = !this.names.length;
    $('intro').hidden = !isFirst && !isWanted;
    $('work').hidden = $('side').hidden = isFirst;
    $('two').hidden = Boolean(isWanted);
    document.body.classList.toggle('first-visit', isFirst);
  }

  /** Shows those that are picked side by side, as far as they have run. */
  async compare() {
    const chosen = this.picks.names.map((name) => this.scenarios.find((scenario) => scenario.name === name)).filter(Boolean);
    const bare = chosen.filter(({ summary }) => !summary);
    if (chosen.length < 2) this.comparison.clear(tr`Tick two to six scenarios to see them side by side.`);
    else if (bare.length) this.comparison.clear(tr`${bare.map(({ name }) => name).join(', ')}: no run is over yet.`);
    else await this.fetchComparison(chosen);
  }

  async fetchComparison(chosen) {
    const state = JSON.stringify(chosen.map(({ name, summary, state: all }) => [name, summary, all]));
    if (state === this.compared && this.comparison.figures) return;
    this.compared = state;
    try {
      const figures = await ask('GET', `/compare?${queryOf(chosen.map(({ name }) => name))}`);
      if (state === this.compared) this.comparison.show(figures, chosen, this.about.default_policies);
    } catch (error) {
      this.compared = null;
      this.comparison.clear(error.message);
    }
  }

  // --- what a person asks for
  async attempt(act) {
    try {
      await act();
    } catch (error) {
      this.notice.say(error.message);
    }
  }

  /** Makes both scenarios, runs them and puts them side by side. */
  async start(pairs) {
    const both = named(pairs, this.names);
    for (const [name, settings] of both) await ask('POST', '/scenarios', { name, settings });
    for (const [name] of both) await ask('POST', pathOf(name, '/run'));
    this.wantsIntro = false;
    await this.look();
    this.picks.set(both.map(([name]) => name));
  }

  async keep(name, settings, runs, old) {
    if (old) await ask('PUT', pathOf(old), { settings });
    const kept = old || (await ask('POST', '/scenarios', { name, settings })).name;
    if (runs) await ask('POST', pathOf(kept, '/run'));
    this.compared = null;
    await this.look();
    if (!old && this.picks.names.length < this.about.most.compared) this.picks.toggle(kept);
  }

  change(name) {
    const { settings, summary } = this.scenarios.find((scenario) => scenario.name === name);
    this.form.open(settings, { old: name, hasRuns: Boolean(summary) });
  }

  async duplicate(name) {
    const { name: copy } = await ask('POST', pathOf(name, '/duplicate'));
    await this.look();
    this.change(copy);
  }

  async rename(name) {
    $('new-name').value = name;
    if (await asked($('renamer')) !== 'yes') return;
    await this.attempt(async () => {
      const { name: to } = await ask('POST', pathOf(name, '/rename'), { to: $('new-name').value });
      this.scenarios.find((scenario) => scenario.name === name).name = to;
      this.picks.rename(name, to);
      await this.look();
    });
  }

  async remove(name) {
    const { runs } = this.scenarios.find((scenario) => scenario.name === name);
    const done = runs.filter(({ state }) => state === 'done').length;
    const text = done ? tr`Its ${runsOf(done)} with their reports are deleted with it.` : tr`It has no runs yet.`;
    if (!await confirmed(tr`Delete ${name}?`, text, tr`Delete`, tr`Keep it`)) return;
    await this.attempt(async () => {
      await ask('DELETE', pathOf(name));
      await this.look();
    });
  }

  // --- files
  openFile(kind) {
    this.kind = kind;
    $('upload').accept = { layouts: '.yaml,.csv', orders: '.csv,.yaml', costs: '.yaml' }[kind];
    $('upload').multiple = kind === 'layouts'; // a layout, and the stock that it names
    $('upload').value = '';
    $('upload').click();
  }

  /** Sends files to the server, stock before layouts, and chooses the requested one. */
  async upload(files) {
    try {
      for (const file of [...files].sort((a, b) => a.name.endsWith('.yaml') - b.name.endsWith('.yaml'))) {
        if (file.size > MOST_FILE) throw new Error(tr`${file.name}: a file of up to 5 MB was expected`);
        const isStock = this.kind === 'layouts' && file.name.endsWith('.csv');
        const { name } = await ask('POST', isStock ? '/stock' : `/${this.kind}`, { name: file.name, text: await file.text() });
        if (this.kind === 'costs') await this.takeCosts();
        else if (!isStock) await this.takeFile(this.kind, name);
      }
    } catch (error) {
      const fields = { layouts: 'building', orders: 'demand', costs: 'costs' };
      if (this.designs.form.dialog.open) this.designs.form.refuse(fields[this.kind], error.message);
      else if (this.form.dialog.open) this.form.say(error.message, 'refused');
      else throw error;
    }
  }

  /** Shows what scenarios cost from now on. */
  async takeCosts() {
    Object.assign(this.about, await ask('GET', '/about'));
    this.showCosts();
    this.compared = null;
    if (this.scenarios) await this.compare();
    if (this.designs.form.dialog.open) this.designs.form.took('costs');
  }

  showCosts() {
    $('costs-told').textContent = this.about.costs ? tr`Costs: those of costs.yaml. ` : tr`What does each cost? `;
    $('costs-drop').hidden = !this.about.costs;
  }

  async takeFile(kind, name) {
    Object.assign(this.about, await ask('GET', '/about'));
    this.intro.offer();
    if (this.designs.form.dialog.open) this.designs.form.took(kind, name);
    else if (!this.form.dialog.open) $('second-layout').value = name;
    else if (kind === 'layouts') this.form.take({ ...this.form.settings(), layout: name });
    else this.form.fillFiles(name);
    this.intro.changed();
    if (this.form.dialog.open) this.form.changed();
  }
}

/** A layout that was drawn in the editor is what a new scenario begins with. */
function takeDrawn(page) {
  const name = new URLSearchParams(location.search).get('layout');
  if (!name) return;
  history.replaceState(null, '', location.pathname + location.hash);
  if (page.about.layouts.includes(name)) page.form.open({ ...page.about.defaults, layout: name }, { taken: page.names });
}

async function main() {
  try {
    const page = new Page(await ask('GET', '/about'));
    window.page = page;
    takeDrawn(page);
  } catch (error) {
    reloadIfLockedOut();
    $('link').textContent = error.message;
    $('link').dataset.state = 'away';
    $('told').append(make('p', { className: 'answer', textContent: error.message }));
    setTimeout(main, LATER);
  }
}

main();
