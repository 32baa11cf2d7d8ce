// SPDX-License-Identifier: Apache-2.0
// Builds a warehouse, adds robots and takes them away.

import { remove, post } from './api.js';
import { $, on } from './dom.js';
import { Placer } from './placer.js';
import { ask, confirmed } from './question.js';

export class Builder extends Placer {
  /** `say(text, kind, at)` tells the person at the page. */
  constructor(say) {
    super('add', { what: 'a robot', hint: 'click the cell where the new robot shall stand' }, say);
    on($('build'), 'click', () => this.build());
    on($('size'), 'change', () => this.showCounts());
    this.showCounts();
  }

  showCounts() {
    $('counts').hidden = $('counts').disabled = $('size').value !== '';
  }

  async build() {
    if (await ask($('builder')) !== 'yes') return;
    this.say('building …', 'sent');
    await this.attempt(() => post('/warehouse', planOf($('size').value, {
      name: $('own-name').value,
      robots: $('own-robots').valueAsNumber,
      shelves: $('own-shelves').valueAsNumber,
      items: $('own-items').valueAsNumber,
    })));
  }

  /** A robot at the grid point [x, y]. */
  async place([x, y], at) {
    await this.put(() => post('/robots', { x, y }), [x, y], at);
  }

  async remove(name) {
    if (!await confirmed(`Take ${name} away?`, 'It ends what it does and is gone.', 'Remove')) return;
    await this.attempt(() => remove(`/robots/${name.match(/\d+$/)[0]}`));
  }
}

/** The body of a request for a warehouse: a preset by its name, or counts of one's own. */
export function planOf(size, { name, robots, shelves, items }) {
  return size ? { name: size } : { name, robots, shelves, items };
}
