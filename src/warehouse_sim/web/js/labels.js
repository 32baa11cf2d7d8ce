// SPDX-License-Identifier: Apache-2.0
// Numbers over the robots that are seen large, and the names of those that matter now.

import { make } from './dom.js';
import { LABEL_HEIGHT, labelled } from './labelled.js';
import { STATUS } from './world.js';

export class Labels {
  /** `box` lies over the picture. */
  constructor(stage, world, box) {
    Object.assign(this, { stage, world, box });
  }

  /** Draws them anew, for a View; `wanted`: a set of indices of robots to name. */
  draw(view, wanted) {
    const { names, numbers } = labelled(this.world, view, wanted);
    const { robots } = this.world.scene;
    const texts = [...names.map((i) => `kiva${robots[i]}`), ...numbers.map((i) => String(robots[i]))];
    const spans = this.box.children;
    while (spans.length < texts.length) this.box.append(make('span'));
    [...names, ...numbers].forEach((i, k) => {
      this.place(spans[k], i, texts[k], k < names.length ? STATUS[this.world.status[i]] : '');
    });
    for (let k = 0; k < spans.length; ++k) spans[k].hidden = k >= texts.length;
  }

  place(span, i, text, kind) {
    const { shown } = this.world;
    const [x, y] = this.stage.pixelOf(shown[3 * i], shown[3 * i + 1], LABEL_HEIGHT);
    if (span.textContent !== text) span.textContent = text;
    if (span.className !== kind) span.className = kind;
    span.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -100%)`;
  }
}
