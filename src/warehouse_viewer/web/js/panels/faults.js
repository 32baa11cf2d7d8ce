// SPDX-License-Identifier: Apache-2.0
// Faults on demand of a robot that is a vehicle of VDA 5050, by which its master is tried.

import { enable, make } from '../base/dom.js';
import { isVehicle } from './vda5050.js';

export const FAULTS = {
  silent: 'silent', lost: 'loses states', doubled: 'doubles states', reordered: 'reorders states', jump: 'jumps',
  refuse: 'refuses orders', slow: 'slow', battery: 'battery low', heading: 'wrong heading', 'error:WARNING': 'a warning',
  error: 'a fatal error', clock: 'clock off',
};
const SPANS = [[0, 'until it is ended'], [10, 'for 10 s'], [60, 'for 1 minute'], [600, 'for 10 minutes']]; // [s]

const option = ([value, textContent]) => make('option', { value, textContent });

export class Faults {
  /** `begin(fault, seconds)` asks the server; '' ends all. */
  constructor(begin) {
    this.kind = make('select', { ariaLabel: 'Fault' }, ...Object.entries(FAULTS).map(option));
    this.span = make('select', { ariaLabel: 'How long' }, ...SPANS.map(option));
    this.begin = make('button', { className: 'edged', textContent: 'Misbehave', title: 'Has this fault, as its master sees it',
      click: () => begin(this.kind.value, Number(this.span.value)) });
    this.end = make('button', { className: 'edged', textContent: 'Behave', title: 'Ends all its faults', click: () => begin('', 0) });
    this.element = make('div', { className: 'care-acts', hidden: true }, this.kind, this.span, this.begin, this.end);
  }

  /** Shows them for the robot of that id, if it is a vehicle; null: no robot. */
  show(id) {
    this.element.hidden = id === null || !isVehicle(id);
    for (const button of [this.begin, this.end]) enable(button, '');
  }
}
