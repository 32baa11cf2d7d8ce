// SPDX-License-Identifier: Apache-2.0
// A button that puts something on the cell that is clicked next.

import { $, isPressed, on, press } from '../base/dom.js';
import { tr } from '../language/texts.js';

export class Placer {
  /** `what` it puts and `hint` are for the person; `say(text, kind, at)` shows them a text. */
  constructor(button, { what, hint }, say) {
    Object.assign(this, { button: $(button), what, hint, say, changed: () => {} });
    on(this.button, 'click', () => this.want(!this.wantsCell));
  }

  /** Whether the next cell that is clicked gets one. */
  get wantsCell() {
    return isPressed(this.button);
  }

  want(wants) {
    if (wants === this.wantsCell) return;
    press(this.button, wants);
    this.changed(); // the page shows which cells are free
    if (wants) this.say(tr`${this.hint}; Esc ends it`, 'sent');
  }

  /** A click that puts nothing says why. */
  refuse(why, at) {
    this.say(`${why}: ${this.hint}`, 'refused', at);
  }

  /** Asks the server for one at [x, y] by `request`; `at` is where in the window the answer belongs. What is
   *  refused can be tried elsewhere at once. */
  async put(request, [x, y], at) {
    this.want(false);
    const isDone = await this.attempt(async () => {
      const { name } = await request();
      return { message: tr`${name} stands at ${x}, ${y}` };
    }, at);
    if (!isDone) this.again();
  }

  again() {
    press(this.button, true);
    this.changed();
  }

  /** True if it was done. */
  async attempt(request, at) {
    try {
      const { message } = await request();
      this.say(message || tr`done`, 'done', at);
      return true;
    } catch (error) {
      this.say(error.message, 'refused', at);
      return false;
    }
  }
}
