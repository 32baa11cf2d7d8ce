// SPDX-License-Identifier: Apache-2.0
// A line of text: beside the pointer, or for some seconds where something was said; or at the top,
// with a button.

import { $, on } from './dom.js';

const STAYS = 5000, OFFERED = 20000; // [ms]

export class Tip {
  constructor() {
    this.box = $('tip');
    this.until = 0;
    this.notice = $('notice');
    on(this.notice.lastElementChild, 'click', () => {
      this.notice.hidden = true;
      this.accept();
    });
  }

  /** Says something at [x, y] of the window, or in its middle. */
  say(text, kind, at) {
    this.until = performance.now() + STAYS;
    this.show(text, kind, at ?? [innerWidth / 2, 120]);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => { this.box.hidden = true; }, STAYS);
  }

  /** Says something with a button for a while; `act()` is called when it is pressed. */
  offer(text, label, act) {
    const [said, button] = this.notice.children;
    said.textContent = text;
    button.textContent = label;
    this.accept = act;
    this.notice.hidden = false;
    clearTimeout(this.offerTimer);
    this.offerTimer = setTimeout(() => { this.notice.hidden = true; }, OFFERED);
  }

  /** The name of what is under the pointer; null: nothing. */
  hover(text, at) {
    if (performance.now() < this.until) return;
    if (text) this.show(text, '', at);
    else this.box.hidden = true;
  }

  show(text, kind, [x, y]) {
    this.box.hidden = false;
    this.box.textContent = text;
    this.box.dataset.kind = kind;
    const half = this.box.offsetWidth / 2;
    this.box.style.left = `${Math.min(innerWidth - half - 4, Math.max(half + 4, x))}px`;
    this.box.style.top = `${Math.max(this.box.offsetHeight + 18, y)}px`;
  }
}
