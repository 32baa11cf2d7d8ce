// SPDX-License-Identifier: Apache-2.0
// The running log of events, and those of one model.

import { $, make, on } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { clock } from '../base/time.js';
import { EVENTS, shownName, TROUBLE } from '../base/words.js';

const KEPT = 1000, SHOWN = 150, OWN = 20;

export class EventLog {
  /** `select(name)` is called for the model of an event that was clicked. */
  constructor(select) {
    this.select = select;
    this.events = [];
    this.own = { name: null, events: [] }; // older ones of the selected, which the server keeps
    this.lastId = 0;
    on($('trouble'), 'change', () => this.drawAll());
    for (const id of ['events', 'own-events']) on($(id), 'keydown', walk);
  }

  /** Adds new events; a server that was restarted counts from 1 again. */
  add(events) {
    if (events[0].id <= this.lastId) this.events = this.events.filter((e) => e.id < events[0].id);
    this.lastId = events[events.length - 1].id;
    this.events = [...this.events, ...events].slice(-KEPT);
    const box = $('events');
    for (const event of events.filter(wanted)) box.prepend(this.line(event));
    while (box.children.length > SHOWN) {
      if (box.lastChild === document.activeElement) box.focus();
      box.lastChild.remove();
    }
  }

  /** Shows these events and no other. */
  replace(events) {
    Object.assign(this, { events: events.slice(-KEPT), lastId: events.at(-1)?.id ?? 0 });
    this.drawAll();
  }

  drawAll() {
    const shown = this.events.filter(wanted).slice(-SHOWN);
    $('events').replaceChildren(...shown.map((event) => this.line(event)).reverse());
  }

  /** Older events of the selected. */
  addOwn(name, events) {
    this.own = { name, events };
    this.drawOwn(name);
  }

  /** The last events of a model into the panel of the selection. */
  drawOwn(name) {
    const all = this.events.filter((e) => e.model === name || e.other === name);
    const older = this.own.name === name ? this.own.events.filter(({ id }) => id < (all[0]?.id ?? Infinity)) : [];
    const own = [...older, ...all].slice(-OWN);
    const lines = own.map((event) => this.line(event)).reverse();
    if (!lines.length) lines.push(make('li', { className: 'dim', textContent: tr`none` }));
    $('own-events').replaceChildren(...lines);
  }

  line({ time, kind, model, other, text }) {
    const words = shownName(text.includes(other) ? text : [other, text].filter(Boolean).join(': ')).replace(/^(done|lifted|repaired|broken): /, '');
    const out = make('li', { click: () => this.select(model), title: words, tabIndex: -1 },
      make('span', { textContent: clock(time) }), make('span', { textContent: EVENTS[kind] ?? kind }),
      make('span', { textContent: shownName(model) }), make('span', { textContent: words }));
    if (isTrouble(kind)) out.dataset.trouble = '';
    return out;
  }
}

/** Arrow keys go from line to line, Enter selects as a click does. */
function walk(event) {
  const { key, currentTarget: list } = event, lines = [...list.children], at = lines.indexOf(document.activeElement);
  const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: lines.length - 1 }[key];
  if (key === 'Enter' && at >= 0) lines[at].click();
  else if (lines[to]) lines[to].focus();
  else return;
  event.preventDefault();
  event.stopPropagation(); // these keys move the selection elsewhere
}

function wanted({ kind }) {
  return !$('trouble').checked || isTrouble(kind);
}

const isTrouble = (kind) => kind === 'ALARM' || TROUBLE.includes(kind);
