// SPDX-License-Identifier: Apache-2.0
// What a person at a station has to do with the unit that is there, big enough for a finger. What is
// sent names the pick that is shown; the buttons wait until the next one is drawn.

import { get, post, put, remove } from './api.js';
import { $, make } from './dom.js';
import { PickOutcome, StationMode } from './message_enums.js';
import { Told } from './told.js';
import { unitDrawing } from './unit_drawing.js';

const SETTLES = 700; // a button that was drawn just now is not meant by a finger on its way [ms]

export class WorkScreen {
  constructor() {
    Object.assign(this, { name: '', shown: null, station: null, link: '' });
    this.told = new Told($('told'));
    this.box = $('task');
  }

  /** The station of that name has the screen; '': none. */
  choose(name) {
    Object.assign(this, { name, shown: null, station: null });
    $('screen').hidden = !name;
    $('overview').hidden = Boolean(name);
    this.told.clear();
    if (name) this.box.replaceChildren(this.head(name, 'looking …'));
  }

  /** How the server is reached; '': well. */
  showLink(text) {
    this.link = text;
    for (const span of this.box.querySelectorAll('.away')) span.textContent = text;
  }

  /** Takes the stations in as they are now. */
  take(stations) {
    if (!this.name) return;
    this.station = stations.find(({ name }) => name === this.name);
    const { mode, picks = [] } = this.station ?? {};
    if (this.shown === this.keyOf(this.station ?? {})) return; // a finger may be on its way to a button
    this.isSure = false;
    this.shown = this.keyOf(this.station ?? {});
    if (!this.station) this.say(`there is no station ${this.name}`);
    else if (mode !== StationMode.MANUAL) this.say(`${this.name} works automatically.`, this.byHand('Work manually', StationMode.MANUAL));
    else if (!picks.length) this.say(this.waitsFor(), this.byHand('Back to automatic', StationMode.AUTOMATIC));
    else this.ask(picks);
  }

  /** All that is drawn of a station; how many picks follow does not matter while a question is asked of the first. */
  keyOf({ mode, shelf_id: unit, picks: [first, ...rest] = [], inbound, open }) {
    const more = first ? this.isSure || rest.length : inbound?.length > 0;
    return JSON.stringify([mode, unit, open, first, more]);
  }

  waitsFor() {
    if (!this.station.open) return 'The station is closed.';
    return this.station.inbound.length ? 'The next storage unit is on its way.' : 'Nothing to be done.';
  }

  byHand(text, mode) {
    return this.button('', text, () => this.send(() => put(`/stations/${this.name}`, { open: this.station.open, mode })));
  }

  button(className, textContent, click) {
    return make('button', { className, textContent, click });
  }

  head(title, text = '') {
    return make('header', {}, make('h1', { textContent: title }), make('span', { className: 'dim', textContent: text }),
      make('span', { className: 'away', textContent: this.link }),
      make('a', { className: 'button', href: '#', textContent: 'All stations' }));
  }

  /** Draws what the screen shows from now on. */
  draw(buttons, ...parts) {
    this.buttons = make('div', { className: 'buttons' }, ...buttons);
    this.box.replaceChildren(...parts, this.buttons);
    this.settle();
  }

  /** Enables the buttons that are there now, in a moment. */
  settle() {
    const drawn = [...this.box.querySelectorAll('button:not(:disabled)')];
    for (const button of drawn) button.disabled = true;
    setTimeout(() => {
      for (const button of drawn) button.disabled = false;
      this.enable?.();
    }, SETTLES);
  }

  say(text, ...buttons) {
    this.enable = null;
    this.draw(buttons, this.head(this.name), make('div', { className: 'idle-text' }, make('p', { className: 'task', textContent: text })));
  }

  ask(picks) {
    const [pick] = picks, { sku, quantity, item, reference } = pick;
    const isPicking = this.station.kind === 'PICK';
    const unit = this.station.shelf_id;
    this.count = quantity;
    const count = make('b');
    const confirm = this.button('confirm strong', 'Confirm', () => this.report(pick, PickOutcome.DONE, this.count));
    this.enable = () => { confirm.disabled = !isPicking && this.count !== quantity; }; // a bundle goes in whole
    const set = (number) => {
      this.count = Math.max(1, Math.min(quantity, number));
      count.textContent = this.count;
    };
    set(quantity);
    const step = (text, by, ariaLabel) => make('button', { textContent: text, ariaLabel, click: () => {
      set(this.count + by);
      this.enable();
    } });
    const short = this.button('short', 'Short', () => this.sure(pick, PickOutcome.SHORT, isPicking));
    short.title = isPicking ? 'the bin is empty' : 'so many pieces are missing';
    const damaged = this.button('damaged', 'Damaged', () => this.sure(pick, PickOutcome.DAMAGED));
    const left = picks.length > 1 ? `then ${picks.length - 1} more` : 'the last one at this unit';
    this.draw([confirm, short, damaged],
      this.head(`${this.name}: storage unit ${unit}`, left), unitDrawing(unit, item, quantity),
      make('div', {}, make('p', { className: 'task', textContent: `${isPicking ? 'Take' : 'Put in'} ${quantity} × ${sku}` }),
        make('p', { textContent: reference ? `bin ${item}, for ${reference}` : `bin ${item}` }),
        make('div', { className: 'count' }, step('−', -1, 'one piece fewer'), count, step('+', 1, 'one piece more'), 'pieces')));
  }

  /** Asks before something is written off; `isEmpty`: whatever the books still have in the bin. */
  async sure(pick, outcome, isEmpty = false) {
    const { buttons, station: { kind } } = this;
    for (const button of this.box.querySelectorAll('button')) button.disabled = true;
    const pieces = isEmpty ? await booked(pick).catch(() => null) : this.count;
    if (this.buttons !== buttons) return; // something else is asked for by now
    const what = `${pieces ?? 'all'} × ${pick.sku}`;
    const isPicking = kind === 'PICK', missing = isPicking ? `Bin ${pick.item} is empty` : 'Not there';
    const why = outcome === PickOutcome.SHORT ? missing : 'Damaged', verb = isPicking ? 'Write off' : 'Leave out';
    buttons.replaceChildren(make('p', { className: 'sure-text', textContent: `${why}: ${verb.toLowerCase()} ${what}?` }),
      this.button('back', 'Back', () => this.redraw()),
      this.button('sure', `${verb} ${what}`, () => this.report(pick, outcome, isEmpty ? 0 : pieces)));
    this.isSure = true;
    this.shown = this.keyOf(this.station);
    this.settle();
  }

  /** Draws what is asked for once more. */
  redraw() {
    this.shown = null;
    if (this.station) this.take([this.station]);
  }

  /** Tells the server what became of a pick; a write-off can be undone for a while. */
  report({ sku, item, order_id: order, sequence }, outcome, quantity) {
    const path = `/stations/${this.name}/picks/${sequence}`;
    return this.send(() => post(path, { order_id: order, item, quantity, outcome }), ({ quantity: pieces }) => {
      if (outcome === PickOutcome.DONE) return this.told.clear();
      const what = `${pieces} × ${sku} in ${item}`;
      return this.told.offer(`${what}: written off`, 'Undo', () => remove(path), `${what}: back in stock`);
    });
  }

  /** Waits for what was asked of the server. Its buttons are dead; what comes next is drawn when the
   *  stations tell. */
  async send(request, done = () => this.told.clear()) {
    const { buttons } = this;
    for (const button of this.box.querySelectorAll('button')) button.disabled = true;
    try {
      done(await request());
    } catch (error) {
      this.told.say(error.message);
      if (this.buttons === buttons) this.redraw();
    }
  }
}

/** Pieces in a pick's bin, by the books. */
async function booked({ sku, item }) {
  const { places } = await get(`/stock?limit=1000&sku=${encodeURIComponent(sku)}`);
  return places.find((place) => place.item === item)?.quantity ?? null;
}
