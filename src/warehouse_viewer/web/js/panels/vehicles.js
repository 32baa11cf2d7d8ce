// SPDX-License-Identifier: Apache-2.0
// The button and the panel of vehicles of other makers at a broker of VDA 5050. The panel is loaded when
// it is first wanted; the button is there as long as a master runs.

import { get } from '../base/api.js';
import { $, isPressed, on, press } from '../base/dom.js';
import { tr } from '../language/texts.js';

const PERIOD = 10_000; // between two looks for a master [ms]

export class Vehicles {
  constructor(page) {
    Object.assign(this, { page, changed: () => {}, what: tr`the vehicle` });
    on($('add-vehicle'), 'click', () => this.open(!isPressed($('add-vehicle'))));
    this.look();
    setInterval(() => this.look(), PERIOD);
  }

  async look() {
    if (document.hidden || document.body.classList.contains('recorded')) return;
    const { runs } = await get('/vda5050/vehicles').catch(() => ({ runs: false }));
    $('add-vehicle').hidden = !runs;
  }

  /** Whether the next cell that is clicked is where the vehicle stands. */
  get wantsCell() {
    return Boolean(this.panel?.wantsCell);
  }

  async open(isOn) {
    press($('add-vehicle'), isOn);
    if (!isOn && !this.panel) return;
    const { VehiclePanel } = await import('./vehicle_panel.js');
    this.panel ??= new VehiclePanel(this);
    this.panel.want(isOn);
  }

  /** Esc and others' cells end it. */
  want(isOn) {
    if (!isOn && isPressed($('add-vehicle'))) this.open(false);
  }

  place(cell) {
    this.panel.place(cell);
  }

  refuse(why, at) {
    this.page.tip.say(tr`${why}: click the cell where the vehicle stands`, 'refused', at);
  }
}
