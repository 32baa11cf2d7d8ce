// SPDX-License-Identifier: Apache-2.0
// A button that puts something on the cell that is clicked next.

import { $, isPressed, on, press } from '../base/dom.js';

export class Placer {
  /** `what` it puts and `hint` are for the person; `say(text, kind, at)` shows them a text. */
  constructor(button, { what, hint }, say) {
    Object.assign(this, { button: $(button), what, hint, say });
    on(this.button, 'click', () => this.want(!this.wantsCell));
  }

  /** Whether the next cell that is clicked gets one. */
  get wantsCell() {
    return isPressed(this.button);
  }

  want(wants) {
    press(this.button, wants);
    if (wants) this.say(this.hint, 'sent');
  }

  /** Asks the server for one at [x, y] by `request`; `at` is where in the window the answer belongs. */
  async put(request, [x, y], at) {
    this.want(false);
    await this.attempt(async () => {
      const { name } = await request();
      return { message: `${name} stands at ${x}, ${y}` };
    }, at);
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
