// SPDX-License-Identifier: Apache-2.0
// People: they come to the cell that is clicked, and the chosen one walks where one clicks next.

import { post } from '../base/api.js';
import { tr } from '../language/texts.js';
import { Placer } from './placer.js';

/** Whether a name is that of a person. */
export const isPerson = (name) => /^person\d+$/.test(name ?? '');

export class People extends Placer {
  /** `say(text, kind, at)` shows the person at the page a text. */
  constructor(say) {
    super('add-person', { what: tr`a person`, hint: tr`click one of the lit cells for the person` }, say);
  }

  /** Adds a person at [x, y] [m]. */
  async place([x, y], at) {
    await this.put(() => post('/people', { x: [x], y: [y] }), [x, y], at);
  }

  async go(name, [x, y], at) {
    await this.attempt(async () => {
      await post('/people', { name, x: [x], y: [y] });
      return { message: tr`${name} walks to ${x}, ${y}` };
    }, at);
  }
}
