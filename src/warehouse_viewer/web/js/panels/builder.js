// SPDX-License-Identifier: Apache-2.0
// Adds robots and takes them away, and opens the dialog that builds a warehouse, which is loaded then.

import { post, remove } from '../base/api.js';
import { $, on } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { Placer } from './placer.js';
import { confirmed } from '../base/question.js';

export class Builder extends Placer {
  /** `say(text, kind, at)` shows the person at the page a text; `present()`: what stands here now,
   *  {robots, shelves, items}, and `isWorking`, whether a fleet works there. */
  constructor(say, present) {
    super('add', { what: tr`a robot`, hint: tr`click one of the lit cells for the new robot` }, say);
    Object.assign(this, { present });
    on($('build'), 'click', () => this.open());
  }

  async open() {
    const { BuildDialog } = await import('./build_dialog.js');
    this.dialog ??= new BuildDialog(() => this.present(), this.say);
    await this.dialog.open();
  }

  /** A robot at the grid point [x, y]. */
  async place([x, y], at) {
    await this.put(() => post('/robots', { x, y }), [x, y], at);
  }

  async remove(name) {
    if (!await confirmed(tr`Remove ${name}?`, tr`Its present command is cancelled.`, tr`Remove`)) return;
    await this.attempt(() => remove(`/robots/${name.match(/\d+$/)[0]}`));
  }
}
