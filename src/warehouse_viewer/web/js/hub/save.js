// SPDX-License-Identifier: Apache-2.0
// The form that saves a world under a name.

import { $, on, setText } from '../base/dom.js';
import { tr } from '../language/texts.js';
import * as server from './server.js';

export class SaveForm {
  /** `say(text)` is called with what was saved. */
  constructor(say) {
    this.say = say;
    on($('save-form'), 'submit', (event) => { event.preventDefault(); this.send(); });
    on($('save-cancel'), 'click', () => $('save').close());
  }

  open(name) {
    this.target = name;
    const { world, replace } = $('save-form').elements;
    setText($('save-title'), tr`Save the world of ${name}`);
    world.value = name;
    replace.checked = false;
    $('save-answer').hidden = true;
    $('save').showModal();
  }

  async send() {
    const { world, replace } = $('save-form').elements;
    try {
      const { message } = await server.save(this.target, { world: world.value.trim(), replace: replace.checked });
      $('save').close();
      this.say(message);
    } catch (error) {
      $('save-answer').hidden = false;
      setText($('save-answer'), error.message);
    }
  }
}
