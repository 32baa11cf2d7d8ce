// SPDX-License-Identifier: Apache-2.0
// Faults on demand of a robot that is a vehicle of VDA 5050, by which its master is tried.

import { enable, make } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { isVehicle } from './vda5050.js';

export const FAULTS = {
  silent: tr`silent`, lost: tr`loses states`, doubled: tr`doubles states`, reordered: tr`reorders states`, jump: tr`jumps`,
  refuse: tr`refuses orders`, slow: tr`slow`, battery: tr`battery low`, heading: tr`wrong heading`, 'error:WARNING': tr`a warning`,
  error: tr`a fatal error`, clock: tr`clock off`,
};
const SPANS = [[0, tr`until it is ended`], [10, tr`for 10 s`], [60, tr`for 1 minute`], [600, tr`for 10 minutes`]]; // [s]

const option = ([value, textContent]) => make('option', { value, textContent });

export class Faults {
  /** `begin(fault, seconds)` asks the server; '' ends all. */
  constructor(begin) {
    this.kind = make('select', { ariaLabel: tr`Fault` }, ...Object.entries(FAULTS).map(option));
    this.span = make('select', { ariaLabel: tr`How long` }, ...SPANS.map(option));
    this.begin = make('button', { className: 'edged', textContent: tr`Misbehave`, title: tr`Has this fault, as its master sees it`,
      click: () => begin(this.kind.value, Number(this.span.value)) });
    this.end = make('button', { className: 'edged', textContent: tr`Behave`, title: tr`Ends all its faults`, click: () => begin('', 0) });
    this.element = make('div', { className: 'care-acts', hidden: true }, this.kind, this.span, this.begin, this.end);
  }

  /** Shows them for the robot of that id, if it is a vehicle; null: no robot. */
  show(id) {
    this.element.hidden = id === null || !isVehicle(id);
    for (const button of [this.begin, this.end]) enable(button, '');
  }
}
