// SPDX-License-Identifier: Apache-2.0
// People: they come to the cell that is clicked, and the chosen one walks where one clicks next.

import { post } from './api.js';
import { $, isPressed, on, press } from './dom.js';

/** Whether a name is that of a person. */
export const isPerson = (name) => /^person\d+$/.test(name ?? '');

export class People {
  /** `say(text, kind, at)` tells the person at the page; `attempt(request, at)` what becomes of one. */
  constructor(say, attempt) {
    Object.assign(this, { say, attempt });
    on($('add-person'), 'click', () => this.want(!this.wantsCell));
  }

  /** Whether somebody comes to the next cell that is clicked. */
  get wantsCell() {
    return isPressed($('add-person'));
  }

  want(wants) {
    press($('add-person'), wants);
    if (wants) this.say('click where the person shall stand', 'sent');
  }

  /** Somebody comes to [x, y]; `at` is where in the window the answer belongs. */
  async come([x, y], at) {
    this.want(false);
    await this.attempt(async () => {
      const { name } = await post('/people', { x: [x], y: [y] });
      return { message: `${name} stands at ${x}, ${y}` };
    }, at);
  }

  async go(name, [x, y], at) {
    await this.attempt(async () => {
      await post('/people', { name, x: [x], y: [y] });
      return { message: `${name} walks to ${x}, ${y}` };
    }, at);
  }
}
