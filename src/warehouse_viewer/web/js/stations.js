// SPDX-License-Identifier: Apache-2.0
// Cards of the stations: their queues, open or closed, by themselves or by hand.

import { put } from './api.js';
import { $, make } from './dom.js';
import { StationMode } from './message_enums.js';

const UNATTENDED = 60; // [s], simulated

export class Stations {
  /** `act(promise)` waits for what was asked of the server. */
  constructor(act) {
    Object.assign(this, { act, cards: new Map() });
  }

  take(stations) {
    const names = stations.map(({ name }) => name);
    if (String(names) !== String([...this.cards.keys()])) {
      this.cards = new Map(names.map((name) => [name, new Card(this.act)]));
      $('stations').replaceChildren(...[...this.cards.values()].map(({ element }) => element));
    }
    for (const station of stations) this.cards.get(station.name).show(station);
  }
}

/** One that stays where it is: a finger may be on its way to a button. */
class Card {
  constructor(act) {
    this.name = make('strong');
    this.busy = make('span', { className: 'dim', title: 'busy, of the time since the shift began' });
    this.work = make('div', { className: 'dim' });
    this.waits = make('div', { className: 'waits-for-person', hidden: true });
    this.queue = make('div', { className: 'queue' });
    this.gate = make('button', { click: () => act(this.set(!this.station.open, this.station.mode)) });
    this.hand = make('button', { click: () => act(this.set(this.station.open,
      this.isByHand ? StationMode.AUTOMATIC : StationMode.MANUAL)) });
    this.screen = make('a', { className: 'button', textContent: 'Screen', title: 'For a person at the station' });
    this.element = make('div', {}, make('header', {}, this.name, this.busy), this.work, this.waits, this.queue,
      make('footer', {}, this.gate, this.hand, this.screen));
  }

  get isByHand() {
    return this.station.mode === StationMode.MANUAL;
  }

  /** Each button sends both: until the server has one, the other waits. */
  async set(open, mode) {
    for (const button of [this.gate, this.hand]) button.disabled = true;
    try {
      const answer = await put(`/stations/${this.station.name}`, { open, mode });
      this.show({ ...this.station, open, mode });
      return answer;
    } finally {
      for (const button of [this.gate, this.hand]) button.disabled = false;
    }
  }

  show(station) {
    const before = this.station;
    this.station = station;
    if (JSON.stringify(before) === JSON.stringify(station)) return;
    const { name, kind, open, orders, slots, pieces, shelf_id: unit, inbound } = station;
    this.name.textContent = name;
    this.element.className = open ? 'station' : 'station shut';
    this.element.dataset.station = name;
    this.busy.textContent = `${Math.round(100 * station.busy_fraction)} % busy`;
    const work = kind === 'PICK' ? `${orders.length} of ${slots} orders, ${pieces} pieces` : `${pieces} pieces put in`;
    this.work.textContent = open ? work : `closed; ${work}`;
    this.waits.textContent = waitingOf(station);
    this.waits.hidden = !this.waits.textContent;
    this.queue.replaceChildren(...unit ? [chip(unit, 'here')] : [], ...inbound.map((other) => chip(other)));
    this.queue.title = `storage units: ${unit ? `${unit} is there, ` : ''}${inbound.length} on their way`;
    this.gate.textContent = open ? 'Close' : 'Open';
    this.hand.textContent = this.isByHand ? 'Automatic' : 'Manual';
    this.screen.href = `/station/${encodeURIComponent(name)}`;
  }
}

/** That a station has waited for a person for a minute or longer; '': it has not. */
export function waitingOf({ waiting }) {
  return waiting < UNATTENDED ? '' : `has waited for a person for ${Math.floor(waiting / 60)} min`;
}

function chip(text, className = '') {
  return make('span', { textContent: text, className });
}
