// SPDX-License-Identifier: Apache-2.0
// Searches for layouts: their list, and what a person does with them.

import { $, on } from '../base/dom.js';
import { confirmed } from '../base/question.js';
import { ROOT } from '../base/root.js';
import { tr } from '../language/texts.js';
import { DesignCard, pathOfDesign } from './design_card.js';
import { DesignForm } from './design_form.js';
import { ask } from './server.js';

export class Designs {
  /** page: {about, attempt, look, takeFile, form, names}. */
  constructor(page) {
    this.page = page;
    this.cards = new Map();
    this.form = new DesignForm(page.about, (...kept) => this.keep(...kept));
    for (const id of ['design', 'design-first']) on($(id), 'click', () => this.form.open(page.about.design_defaults, this.names));
    const send = (method) => (name) => page.attempt(async () => {
      await ask(method, pathOfDesign(name, '/run'));
      await page.look();
    });
    this.actions = {
      run: send('POST'), cancel: send('DELETE'),
      again: (name) => this.form.open(this.settingsOf(name), this.names),
      remove: (name) => this.remove(name),
      use: (name, layout) => page.attempt(() => this.use(name, layout)),
    };
  }

  get names() {
    return this.all?.map(({ name }) => name) ?? [];
  }

  settingsOf(wanted) {
    return this.all.find(({ name }) => name === wanted).settings;
  }

  show(all) {
    this.all = all;
    $('designs').hidden = !all.length;
    for (const [name, card] of this.cards) {
      if (this.names.includes(name)) continue;
      card.element.remove();
      this.cards.delete(name);
    }
    all.forEach((design, i) => {
      if (!this.cards.has(design.name)) this.cards.set(design.name, new DesignCard(design.name, this.actions));
      const card = this.cards.get(design.name);
      card.update(design);
      if ($('design-list').children[i] !== card.element) $('design-list').insertBefore(card.element, $('design-list').children[i] ?? null);
    });
  }

  async keep(name, settings) {
    const kept = await ask('POST', '/designs', { name, settings });
    await ask('POST', pathOfDesign(kept.name, '/run'));
    await this.page.look();
    this.cards.get(kept.name)?.element.scrollIntoView({ block: 'nearest' });
  }

  async remove(name) {
    if (!await confirmed(tr`Delete ${name}?`, tr`What it found, and its shifts, are deleted with it.`, tr`Delete`, tr`Keep it`)) return;
    await this.page.attempt(async () => {
      await ask('DELETE', pathOfDesign(name));
      await this.page.look();
    });
  }

  /** Keeps a layout that was found among those of scenarios, and begins one with it. */
  async use(name, layout) {
    const answer = await fetch(`${ROOT}/whatif${pathOfDesign(name, `/layouts/${encodeURIComponent(layout)}`)}`);
    if (!answer.ok) throw new Error(tr`the layout is gone`);
    const file = `${name.replace(/[^\w.-]+/g, '_')}-${layout}`;
    const { name: kept } = await ask('POST', '/layouts', { name: file, text: await answer.text() });
    await this.page.takeFile('layouts', kept);
    this.page.form.open({ ...this.page.about.defaults, layout: kept }, { taken: this.page.names });
  }
}
