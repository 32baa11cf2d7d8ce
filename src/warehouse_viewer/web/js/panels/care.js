// SPDX-License-Identifier: Apache-2.0
// What the server says of a robot or station that is selected, and what a person can do about it: why it
// waits and where it goes, repair and tow, who works at a station, open or closed, its last events.

import { get, post, put } from '../base/api.js';
import { $, enable, make, press } from '../base/dom.js';
import { RobotMode, StationMode } from '../base/message_enums.js';
import { knownPerson } from '../base/person.js';
import { ROOT } from '../base/root.js';
import { Choice, waitsOf } from '../base/station.js';
import { tr } from '../language/texts.js';
import { lasting } from '../base/time.js';
import { NEEDS_HELP, shownName, STATION_STATES } from '../base/words.js';
import { Faults } from './faults.js';

export { knownPerson };
export { plannedOf, vda5050Of } from './vda5050.js';

const EVENTS = 20, PAST_EVERY = 1000; // events asked for; between two questions about the past [ms]
const LONG = 10; // from which a span is worth saying [s]
const WORKS = { [StationMode.AUTOMATIC]: [tr`automatic`, tr`It picks by itself`], [StationMode.MANUAL]: [tr`manual`, tr`A person works at its screen`] };

export class Care {
  /** `details` is the Details whose selection it is; `moment()` the time that is shown [s], null: now,
   *  undefined: of a recording, of which no server knows reasons; `log` the EventLog. */
  constructor(details, { moment, log }) {
    Object.assign(this, { details, moment, log, why: null, read: null, asked: -Infinity, choice: new Choice() });
    this.text = make('p', { className: 'reason' });
    this.errand = make('p', { className: 'dim hint' });
    this.modes = make('div', { className: 'filters modes' }, ...Object.entries(WORKS).map(([mode, [textContent, title]]) => {
      const button = make('button', { textContent, title, click: () => this.setStation({ mode }) });
      button.dataset.stationMode = mode;
      return button;
    }));
    this.modes.setAttribute('role', 'group');
    this.modes.ariaLabel = tr`Who works there`;
    this.gate = make('button', { className: 'edged', click: () => this.setStation({ open: !this.station.open }) });
    this.screen = make('a', { className: 'button edged', textContent: tr`Screen`, title: tr`For a person who works there` });
    this.repair = make('button', { className: 'edged', textContent: tr`Repair`, title: tr`Repairs all that is broken in it`, click: () => this.mend('repair') });
    this.tow = make('button', { className: 'edged', textContent: tr`Tow`, title: tr`Moves it, with its load, to where it is in no way`, click: () => this.mend('tow') });
    this.acts = make('div', { className: 'care-acts' }, this.repair, this.tow, this.gate, this.screen);
    this.faults = new Faults((fault, seconds) => this.misbehave(fault, seconds));
    $('care').replaceChildren(this.text, this.errand, this.modes, this.acts, this.faults.element);
  }

  get name() {
    return this.details.name;
  }

  get station() {
    const newest = this.details.stationOf(this.name);
    return newest && this.choice.upon(newest, performance.now());
  }

  /** Another thing is selected. */
  show() {
    Object.assign(this, { why: null, read: null, asked: -Infinity, choice: new Choice() });
    this.refresh();
  }

  /** The server's reason; null: it knows none. */
  take(why) {
    if (why?.name !== this.name) return;
    this.why = why;
    this.readEvents();
    this.refresh();
  }

  /** The newest events of all do not go far back where many robots work. */
  async readEvents() {
    const { name } = this;
    if (this.read === name) return;
    this.read = name;
    const { events } = await get(`/events?limit=${EVENTS}&model=${encodeURIComponent(name)}`).catch(() => ({ events: [] }));
    if (this.name === name) this.log.addOwn(name, events);
  }

  refresh() {
    const { thing } = this.details, isRobot = thing?.kind === 'robot', isStation = thing?.kind === 'station';
    $('care').hidden = !isRobot && !isStation;
    if ($('care').hidden) return;
    if (this.moment() !== null) this.askPast(this.moment());
    this.showWhy(isStation);
    this.showRobot(isRobot ? thing.index : -1);
    this.showStation(isStation ? this.station : null);
    this.acts.hidden = [...this.acts.children].every(({ hidden }) => hidden);
  }

  /** Asks why it waited at a time [s] of a running warehouse. */
  async askPast(time) {
    const now = performance.now(), { name } = this;
    if (time === undefined || now - this.asked < PAST_EVERY) return;
    this.asked = now;
    const why = await get(`/why/${encodeURIComponent(name)}?time=${time.toFixed(1)}`).catch(() => null);
    if (this.name !== name || this.moment() === null) return;
    this.why = why && { ...why, text: why.sentence.replace(`${name} `, ''), errand: '', since: Infinity };
    this.showWhy(this.details.thing?.kind === 'station');
  }

  showWhy(isStation) {
    const { text = '', errand = '', since = 0, cause = '' } = this.why ?? {};
    const span = this.details.world.stamp - since;
    const words = `${text}${text && span >= LONG ? tr`, for ${lasting(span)}` : ''}`;
    this.link(this.text, isStation ? '' : words); // a station's facts have it
    this.text.classList.toggle('is-caused', Boolean(cause));
    this.link(this.errand, errand);
  }

  /** A text in which the names of things lead to them. */
  link(element, text) {
    element.hidden = !text;
    if (element.dataset.text === text) return; // a finger may be on its way to a name
    element.dataset.text = text;
    const stations = this.details.world.scene.stations.map(({ name }) => name);
    const names = new RegExp(`\\b(${['kiva\\d+', 'unit \\d+', ...stations.map(escaped)].join('|')})\\b`);
    element.replaceChildren(...text.split(names).map((part, i) => {
      const name = part.replace(/^unit /, 'storage_unit');
      return i % 2 && name !== this.name ? make('button', { className: 'link-text', textContent: part, click: () => this.details.select(name) }) : part;
    }));
  }

  // --- a robot
  showRobot(index) {
    const { world, fleet } = this.details;
    const isBroken = index >= 0 && world.failures[index] !== 0;
    const needs = isBroken || (index >= 0 && world.activity[index] === NEEDS_HELP);
    const mode = index >= 0 && fleet.modeOf(world.scene.robots[index]);
    this.repair.hidden = !needs;
    this.tow.hidden = !needs && mode !== RobotMode.OUT_OF_SERVICE;
    this.faults.show(index >= 0 ? world.scene.robots[index] : null);
    enable(this.repair, isBroken ? '' : tr`nothing is broken in it`);
    enable(this.tow, fleet.runs ? '' : tr`no coordinator runs`);
  }

  get id() {
    return Number(this.name.match(/\d+$/)[0]);
  }

  mend(what) {
    const { id } = this;
    this.details.attempt(() => post(`/robots/${id}/${what}`, { by: knownPerson() }));
  }

  misbehave(fault, seconds) {
    const { id } = this;
    this.details.attempt(() => post(`/vda5050/${id}/faults`, { fault, seconds, by: knownPerson() }));
  }

  // --- a station
  showStation(station) {
    for (const element of [this.modes, this.gate, this.screen]) element.hidden = !station;
    if (!station) return;
    for (const button of this.modes.children) {
      press(button, button.dataset.stationMode === station.mode);
      enable(button, '');
    }
    this.gate.textContent = station.open ? tr`Close` : tr`Open`;
    enable(this.gate, '');
    this.screen.href = `${ROOT}/station/${encodeURIComponent(this.name)}`;
  }

  setStation(change) {
    const { open, mode } = this.station, chosen = { open, mode, ...change };
    this.choice.note(chosen, performance.now());
    this.details.attempt(() => put(`/stations/${encodeURIComponent(this.name)}`, { ...chosen, by: knownPerson() }));
    this.refresh();
  }
}

/** What a station does, waits for and has in its queue, as [what, value]. */
export function factsOfStation(station, now, link) {
  if (!station) return [[tr`state`, tr`no shift is running`]];
  const { open, activity, queue, shelf_id: unit, picks = [], orders = [], kind } = station;
  const [waits] = waitsOf(station, now);
  const units = queue.map(({ unit: next }) => next).filter((next) => next !== unit);
  const robots = queue.filter(({ robot }) => robot).map(({ robot }) => link(`kiva${robot}`));
  return [[tr`state`, !open && activity === 'RESTING' ? tr`closed` : STATION_STATES[activity]],
    ...waits ? [[tr`why`, linked(shownName(waits), link)]] : [],
    [tr`unit`, unit ? [link(`storage_unit${unit}`), tr` ${picks.length} to ${kind === 'PICK' ? tr`pick` : tr`put in`}`] : tr`none is there`],
    [tr`queue`, robots.length ? robots : tr`no robot`],
    ...units.length ? [[tr`on its way`, units.map((next) => link(`storage_unit${next}`))]] : [],
    ...kind === 'PICK' ? [[tr`orders`, String(orders.length)]] : []];
}

/** The parts of a sentence, of which robots and units are links. */
function linked(text, link) {
  return text.split(/\b(kiva\d+|unit \d+)\b/).filter(Boolean).map((part) => (
    /^(kiva|unit )\d+$/.test(part) ? { ...link(part.replace(/^unit /, 'storage_unit')), isInText: true } : part));
}

const escaped = (text) => text.replaceAll(/[.*+?^${}()|[\]\\]/g, '\\$&');
