// SPDX-License-Identifier: Apache-2.0
// Two layouts against each other, in one go: what a first visitor sees.

import { $, on } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { fillLayouts, freeName, hintCounts } from './choices.js';
import { faultOf, goToFault } from './numbers.js';
import { ask } from './server.js';
import { duration, layoutOf } from './words.js';

const SIDES = ['first', 'second'];
const PRESETS = ['small', 'medium'];

export class Intro {
  /** start(pairs): makes [name, settings] of both, runs and compares them; rejects with the reason. */
  constructor(about, start) {
    Object.assign(this, { about, start });
    this.offer();
    SIDES.forEach((side, i) => { $(`${side}-layout`).value = PRESETS[i]; });
    $('intro-minutes').value = about.defaults.minutes;
    $('intro-seeds').value = about.defaults.seeds;
    for (const what of ['minutes', 'seeds']) $(`intro-${what}`).max = about.most[what];
    for (const side of SIDES) $(`${side}-robots`).max = about.most.robots;
    on($('intro-form'), 'submit', (event) => {
      event.preventDefault();
      this.send();
    });
    on($('intro-form'), 'input', () => this.changed());
    this.changed();
  }

  async send() {
    const fault = faultOf($('intro-form'));
    if (fault) {
      this.say(fault, 'refused');
      goToFault($('intro-form'));
      return;
    }
    try {
      await this.start(this.pairs());
    } catch (error) {
      this.say(error.message, 'refused');
    }
  }

  /** Says beside the button how long it takes, or what is wrong: a refusal goes with the next change. */
  say(text, kind) {
    clearTimeout(this.timer);
    $('intro-time').textContent = text;
    $('intro-time').className = kind === 'refused' ? 'answer' : 'dim';
    $('intro-time').dataset.kind = kind;
  }

  /** Offers what files there are. */
  offer() {
    for (const side of SIDES) fillLayouts($(`${side}-layout`), this.about);
  }

  settings(side) {
    const { defaults } = this.about;
    return {
      ...defaults,
      layout: $(`${side}-layout`).value,
      robots: $(`${side}-robots`).valueAsNumber || 0,
      minutes: $('intro-minutes').valueAsNumber || 0,
      seeds: $('intro-seeds').valueAsNumber || 0,
    };
  }

  /** [name, settings] of both; the names have the count of robots where the layout is the same. */
  pairs() {
    const both = SIDES.map((side) => this.settings(side));
    const isSame = both[0].layout === both[1].layout;
    return both.map((settings) => [
      layoutOf(settings.layout) + (isSame && settings.robots ? tr` ${settings.robots} robots` : ''), settings]);
  }

  changed() {
    for (const side of SIDES) hintCounts(this.about, $(`${side}-layout`).value, [[$(`${side}-robots`), 'robots']]);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.estimate(), 300);
  }

  async estimate() {
    const fault = faultOf($('intro-form'));
    if (fault) {
      this.say(fault, 'refused');
      return;
    }
    try {
      const each = await Promise.all(SIDES.map((side) => ask('POST', '/estimate', { settings: this.settings(side) })));
      this.say(tr`takes about ${duration(each.reduce((sum, { seconds }) => sum + seconds, 0))} here`, '');
    } catch (error) {
      this.say(error.message, 'refused');
    }
  }
}

/** Names that are free, for scenarios that are made together. */
export function named(pairs, taken) {
  const known = [...taken];
  return pairs.map(([stem, settings]) => {
    const name = freeName(stem, known);
    known.push(name);
    return [name, settings];
  });
}
