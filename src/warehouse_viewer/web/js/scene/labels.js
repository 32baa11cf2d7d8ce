// SPDX-License-Identifier: Apache-2.0
// Numbers over the robots that are seen large, and the names of those that matter now.

import { make } from '../base/dom.js';
import { LABEL_HEIGHT, labelled } from './labelled.js';
import { ACTIVITY_CLASS } from '../base/words.js';

export class Labels {
  /** `box` lies over the picture. */
  constructor(stage, world, box) {
    Object.assign(this, { stage, world, box });
  }

  /** Draws all labels, for a View; `wanted`: a set of indices of robots to name; `more` labels
   *  {text, kind, at [x, y, z], note}. */
  draw(view, always, more) {
    const { names, numbers } = labelled(this.world, view, always);
    const { robots } = this.world.scene;
    const { shown, activity } = this.world;
    const labels = [
      ...names.map((i) => [`kiva${robots[i]}`, ACTIVITY_CLASS[activity[i]], i]),
      ...numbers.map((i) => [String(robots[i]), '', i]),
    ].map(([text, kind, i]) => ({ text, kind, at: [shown[3 * i], shown[3 * i + 1], LABEL_HEIGHT] }));
    labels.push(...more);
    this.box.classList.toggle('above', view.isParallel);
    const spans = this.box.children;
    while (spans.length < labels.length) this.box.append(make('span'));
    labels.forEach((label, k) => this.place(spans[k], label));
    for (let k = 0; k < spans.length; ++k) spans[k].hidden = k >= labels.length;
  }

  place(span, { text, kind, at, note = '' }) {
    const [x, y] = this.stage.pixelOf(...at).map(Math.round);
    if (span.textContent !== text) span.textContent = text;
    if (span.className !== kind) span.className = kind;
    if ((span.dataset.note ?? '') !== note) span.dataset.note = note;
    // All of it within the window, and signs below the bar; percentages are of the label's own size.
    const down = kind.startsWith('sign') ? `max(${y}px, var(--free-top) - var(--over))` : `${y}px`;
    const place = `clamp(50%, ${x}px, 100vw - 50%) ${down}`;
    if (span.place !== place) span.style.translate = place; // the same would be painted again
    span.place = place;
  }
}
