// SPDX-License-Identifier: Apache-2.0
// A line with what became of something, which can be taken back for a while. It
// stays when what is around it is drawn again.

import { make } from '../base/dom.js';

const OFFERED = 10; // [s]
const SHOWN = 15; // a refusal [s]

export class Notice {
  constructor(box) {
    this.box = box;
  }

  clear() {
    clearInterval(this.timer);
    this.box.replaceChildren();
  }

  say(text, kind = 'refused') {
    this.clear();
    this.box.append(make('span', { className: 'answer', textContent: text }));
    this.box.firstChild.dataset.kind = kind;
    this.timer = setTimeout(() => this.clear(), 1000 * SHOWN);
  }

  /** Says what was done; `act()` takes it back, and `undone` says so then. */
  offer(text, label, act, undone) {
    this.say(text, 'done');
    clearTimeout(this.timer);
    const button = make('button', { className: 'undo', click: () => this.take(button, act, undone) });
    const count = (left) => { button.textContent = `${label} (${left})`; };
    let left = OFFERED;
    count(left);
    this.box.append(button);
    this.timer = setInterval(() => {
      left -= 1;
      if (left) count(left);
      else this.clear();
    }, 1000);
  }

  async take(button, act, undone) {
    clearInterval(this.timer);
    button.disabled = true;
    try {
      await act();
      this.say(undone, 'done');
    } catch (error) {
      this.say(error.message);
    }
  }
}
