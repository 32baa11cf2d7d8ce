// SPDX-License-Identifier: Apache-2.0
// The card of one simulation in the list.

import { make, setText } from '../base/dom.js';
import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';
import { look, paint } from './picture.js';

const PERIOD = 1000; // between two pictures [ms]
const STATES = { STARTING: tr`starting`, RUNNING: tr`running`, PAUSED: tr`paused`, FAILED: tr`failed`, STOPPED: tr`stopped` };
/** What buttons say, by what Card is given as their names. */
const LABELS = {
  'Insert a world': tr`Insert a world`, 'Save as': tr`Save as`, 'Keep recording': tr`Keep recording`, Log: tr`Log`,
  Start: tr`Start`, Restart: tr`Restart`, Stop: tr`Stop`, Delete: tr`Delete`,
};
const COLOURS = { STARTING: 'waiting', RUNNING: 'working', PAUSED: 'resting', FAILED: 'needs-help', STOPPED: 'resting' };

/** A list item; `does` maps what a button is called to what it does with the simulation. */
export class Card {
  constructor(name, does) {
    this.name = name;
    this.badge = make('span', { className: 'badge' });
    this.link = make('a', { textContent: name });
    this.canvas = make('canvas', { role: 'img', ariaLabel: tr`the floor of ${name}` });
    this.facts = make('dl');
    this.reason = make('p', { className: 'reason dim' });
    this.buttons = Object.fromEntries(Object.entries(does).map(([text, action]) =>
      [text, make('button', { className: 'edged', textContent: LABELS[text], click: () => action(this.row) })]));
    this.open = make('a', { className: 'button strong', textContent: tr`Open` });
    this.element = make('li', { className: 'card simulation' },
      make('h3', {}, this.link, this.badge), this.canvas, this.facts, this.reason,
      make('div', { className: 'row' }, this.open, ...Object.values(this.buttons)));
    this.looked = 0;
  }

  show(row) {
    this.row = row;
    const lives = isShown(row.state);
    setText(this.badge, STATES[row.state] ?? row.state.toLowerCase());
    this.badge.className = `badge ${COLOURS[row.state]}`;
    this.link.href = this.open.href = row.url;
    this.open.hidden = !lives;
    this.canvas.hidden = !lives;
    this.showFacts(row);
    setText(this.reason, row.reason);
    this.reason.hidden = !row.reason;
    for (const [text, button] of Object.entries(this.buttons)) button.hidden = !isOffered(text, row.state);
    if (lives && performance.now() - this.looked > PERIOD) this.picture();
  }

  showFacts(row) {
    const texts = Object.entries(row.arguments).map(([name, value]) => `${name}:=${value}`).join(' ');
    const lives = row.uptime_s > 0;
    const facts = {
      [tr`Robots`]: lives && row.robots > 0 && number(row.robots), [tr`Size`]: lives && row.storage_units ? tr`${number(row.storage_units)} storage units, ${number(row.items)} items` : '',
      [tr`Orders`]: lives && ordersOf(row.orders), [tr`Speed`]: lives && row.rtf ? `×${number(row.rtf, 2)}` : '',
      [tr`Runs`]: lives && durationOf(row.uptime_s), [tr`Arguments`]: texts,
    };
    const pairs = Object.entries(facts).filter(([, value]) => value);
    const text = JSON.stringify(pairs);
    if (text === this.shownFacts) return;
    this.shownFacts = text;
    this.facts.replaceChildren(...pairs.flatMap(([name, value]) => [make('dt', { textContent: name }), make('dd', { textContent: value })]));
  }

  async picture() {
    this.looked = performance.now();
    const places = await look(this.row.url).catch(() => null);
    if (places) paint(this.canvas, places);
  }
}

function ordersOf({ waiting, at_stations: atStations, completed } = {}) {
  return completed === undefined ? '' : tr`${waiting} wait, ${atStations} at stations, ${completed} done`;
}

function isOffered(text, state) {
  const lives = ['STARTING', 'RUNNING', 'PAUSED'].includes(state);
  return { Start: !lives, Delete: !lives, Stop: lives, Restart: lives,
    'Insert a world': isShown(state), 'Save as': isShown(state), 'Keep recording': isShown(state) }[text] ?? true;
}

const isShown = (state) => state === 'RUNNING' || state === 'PAUSED';

export function durationOf(seconds) {
  const minutes = Math.floor(seconds / 60);
  if (minutes < 1) return `${Math.round(seconds)} s`;
  return minutes < 60 ? tr`${minutes} min` : tr`${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}
