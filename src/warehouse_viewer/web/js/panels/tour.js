// SPDX-License-Identifier: Apache-2.0
// Five stops through the page, each beside what it is about.

import { make, on } from '../base/dom.js';
import { marginsOf } from '../base/drawers.js';
import { tr } from '../language/texts.js';

const GAP = 12; // between the card and what it is about, and the window's edge [px]
/** Of each stop: the elements that it may be about, the first that is there; its title and text. */
const STOPS = [
  [['#stage'], tr`The floor`, tr`Grey robots rest, blue ones drive, green ones work, amber ones wait too long, red ones need help. Drag to turn, wheel or pinch to zoom, click what you want to know more about.`],
  [['#bar .tools'], tr`Time`, tr`Pause, go faster, save a checkpoint, go back to it. All of it is a simulation: nothing can be spoilt.`],
  [['#rail [data-drawer="list-panel"]'], tr`Robots and search`, tr`Every robot, and a search for robots, storage units, stations and goods. Selected robots take commands: click a cell of the floor.`],
  [['#fleet-tab', '#bar .site'], tr`What goes wrong`, tr`Alarms by their cause, each with what helps. Orders, stations and stock are on the page Operations.`],
  [['#timeline', '#help'], tr`What was`, tr`Every moment of the last hour can be seen again: click it, and Live brings you back.`],
];

export class Tour {
  /** `closed()` is called when a person has seen it, or wants no more of it. */
  constructor(closed) {
    Object.assign(this, { closed, at: 0 });
    this.title = make('h2');
    this.text = make('p');
    this.count = make('span', { className: 'dim' });
    this.back = make('button', { className: 'edged', textContent: tr`Back`, click: () => this.go(this.at - 1) });
    this.next = make('button', { className: 'strong', click: () => this.go(this.at + 1) });
    const close = make('button', { className: 'plain', title: tr`Close the tour`, ariaLabel: tr`Close the tour`, textContent: '×', click: () => this.end() });
    this.card = make('section', { id: 'tour', className: 'tour panel', hidden: true, ariaLabel: tr`Tour` },
      make('header', {}, this.title, close), this.text, make('footer', {}, this.count, this.back, this.next));
    document.body.append(this.card);
    on(window, 'resize', () => this.place());
    on(this.card, 'keydown', (event) => event.key === 'Escape' && this.end());
  }

  begin() {
    this.card.hidden = false;
    this.go(0);
  }

  go(at) {
    if (at >= STOPS.length) {
      this.end();
      return;
    }
    this.at = at;
    const [, title, text] = STOPS[at];
    this.title.textContent = title;
    this.text.textContent = text;
    this.count.textContent = tr`${at + 1} of ${STOPS.length}`;
    this.back.hidden = at === 0;
    this.next.textContent = at === STOPS.length - 1 ? tr`Done` : tr`Next`;
    this.place();
  }

  get about() {
    return STOPS[this.at][0].map((selector) => document.querySelector(selector)).find((element) => element?.checkVisibility());
  }

  /** Marks what the stop is about, and puts the card beside it. */
  place() {
    this.marked?.classList.remove('toured');
    if (this.card.hidden) return;
    this.marked = this.about;
    this.marked?.classList.add('toured');
    const of = this.marked?.getBoundingClientRect() ?? { left: 0, right: 0, top: 0, bottom: 0 };
    const { offsetWidth: width, offsetHeight: height } = this.card;
    const [left, top] = this.at === 0 ? [(innerWidth - width) / 2, innerHeight - marginsOf().bottom - height]
      : of.right < innerWidth / 8 ? [of.right + GAP, of.top]
        : [(of.left + of.right - width) / 2, of.top > innerHeight / 2 ? of.top - height - GAP : of.bottom + GAP];
    this.card.style.left = `${Math.max(GAP, Math.min(left, innerWidth - width - GAP))}px`;
    this.card.style.top = `${Math.max(GAP, Math.min(top, innerHeight - height - GAP))}px`;
  }

  end() {
    this.card.hidden = true;
    this.place();
    this.closed();
  }
}
