// SPDX-License-Identifier: Apache-2.0
// The invitation: what a newcomer can do with one click. It opens by itself once, where robots stand that
// no coordinator drives; the rail opens it again.

import { $, enable, make, on } from '../base/dom.js';
import { tr } from '../language/texts.js';

const PATIENCE = 1500; // for news of a coordinator that runs [ms]
const SHOWN = 'start-shown'; // in localStorage, once it has opened by itself

export class Start {
  /** `page` is the Page. */
  constructor(page) {
    this.page = page;
    document.head.append(make('link', { rel: 'stylesheet', href: '/web/start.css' }));
    for (const button of $('start-panel').querySelectorAll('[data-step]')) on(button, 'click', () => this.take(button.dataset.step));
    on($('start-close'), 'click', () => page.drawers.close('start-panel'));
  }

  /** The server's status. */
  takeStatus({ lacks = {} }) {
    this.lack = lacks.start_shift ?? '';
    $('start-tab').hidden = $('start-panel').hidden = false;
    this.refresh();
    if (this.lack || this.timer || localStorage.getItem(SHOWN)) return;
    this.timer = setTimeout(() => this.invite(), PATIENCE);
  }

  invite() {
    const { fleet, world, drawers, timeline } = this.page;
    if (fleet.runs || !world.scene.robots.length || !timeline.isLive) return;
    localStorage.setItem(SHOWN, 'yes');
    drawers.open('start-panel');
  }

  /** A coordinator came or went. */
  refresh() {
    enable($('start-shift'), this.isBusy ? tr`it is being started` : this.lack);
  }

  async take(step) {
    const { FirstSteps } = await import('./first_steps.js');
    this.steps ??= new FirstSteps(this.page);
    this.isBusy = step === 'shift';
    this.refresh();
    const isDone = await this.steps.take(step);
    this.isBusy = false;
    this.refresh();
    if (isDone && step === 'shift') this.page.drawers.close('start-panel');
  }
}
