// SPDX-License-Identifier: Apache-2.0
// Builds a warehouse, adds robots and takes them away.

import { remove, post } from './api.js';
import { $, isPressed, on, press } from './dom.js';
import { ask, confirmed } from './question.js';

export class Builder {
  /** `say(text, kind, at)` tells the person at the page. */
  constructor(say) {
    this.say = say;
    on($('build'), 'click', () => this.build());
    on($('size'), 'change', () => this.showCounts());
    on($('add'), 'click', () => this.want(!isPressed($('add'))));
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

  /** Whether the next cell that is clicked gets a robot. */
  get wantsCell() {
    return isPressed($('add'));
  }

  want(wants) {
    press($('add'), wants);
    if (wants) this.say('click the cell where the new robot shall stand', 'sent');
  }

  /** A robot at the grid point [x, y]; `at` is where in the window the answer belongs. */
  async add([x, y], at) {
    this.want(false);
    await this.attempt(async () => {
      const { name } = await post('/robots', { x, y });
      return { message: `${name} stands at ${x}, ${y}` };
    }, at);
  }

  async remove(name) {
    if (!await confirmed(`Take ${name} away?`, 'It ends what it does and is gone.', 'Remove')) return;
    await this.attempt(() => remove(`/robots/${name.match(/\d+$/)[0]}`));
  }

  async attempt(request, at) {
    try {
      const { message } = await request();
      this.say(message || 'done', 'done', at);
    } catch (error) {
      this.say(error.message, 'refused', at);
    }
  }
}

/** The body of a request for a warehouse: a preset by its name, or counts of one's own. */
export function planOf(size, { name, robots, shelves, items }) {
  return size ? { name: size } : { name, robots, shelves, items };
}
