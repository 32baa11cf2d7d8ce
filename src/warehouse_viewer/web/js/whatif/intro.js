// SPDX-License-Identifier: Apache-2.0
// Two layouts against each other, in one go: what a first visitor sees.

import { $, on } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { fillLayouts, freeName, hintCounts } from './choices.js';
import { ask } from './server.js';
import { duration, layoutOf } from './words.js';

const SIDES = ['first', 'second'];
const PRESETS = ['small', 'medium'];

export class Intro {
  /**
   * start(pairs): makes [name, settings] of both, runs and compares them.
   * mended(): called as soon as the form changes, so that an earlier refusal goes.
   */
  constructor(about, start, mended) {
    this.about = about;
    this.offer();
    SIDES.forEach((side, i) => { $(`${side}-layout`).value = PRESETS[i]; });
    $('intro-minutes').value = about.defaults.minutes;
    $('intro-seeds').value = about.defaults.seeds;
    for (const what of ['minutes', 'seeds']) $(`intro-${what}`).max = about.most[what];
    on($('intro-form'), 'submit', (event) => {
      event.preventDefault();
      start(this.pairs());
    });
    on($('intro-form'), 'input', () => {
      mended();
      this.changed();
    });
    this.changed();
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
    try {
      const each = await Promise.all(SIDES.map((side) => ask('POST', '/estimate', { settings: this.settings(side) })));
      $('intro-time').textContent = tr`takes about ${duration(each.reduce((sum, { seconds }) => sum + seconds, 0))} here`;
    } catch (error) {
      $('intro-time').textContent = error.message;
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
