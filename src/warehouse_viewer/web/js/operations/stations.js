// SPDX-License-Identifier: Apache-2.0
// Stations as rows: what each does, what it waits for and for how long; open or closed, by
// themselves or by hand.

import { put } from '../base/api.js';
import { $, make, press, whileBusy } from '../base/dom.js';
import { StationMode } from '../base/message_enums.js';
import { number, percent } from '../language/numbers.js';
import { knownPerson } from '../base/person.js';
import { ROOT } from '../base/root.js';
import { Choice, waitsOf } from '../base/station.js';
import { tr } from '../language/texts.js';
import { lasting } from '../base/time.js';
import { ACTIVITY_CLASS, ACTIVITY_NAMES, STATION_STATES } from '../base/words.js';

const CHIPS = 8; // most robots of a queue that are shown

export class Stations {
  /** `act(promise)` waits for what was asked of the server. */
  constructor(act) {
    Object.assign(this, { act, rows: new Map(), now: 0 });
  }

  take(stations) {
    const names = stations.map(({ name }) => name);
    if (String(names) !== String([...this.rows.keys()])) {
      this.rows = new Map(names.map((name) => [name, new Row(this.act)]));
      $('stations').replaceChildren(...[...this.rows.values()].map(({ element }) => element));
    }
    for (const station of stations) this.rows.get(station.name).show(station, this.now);
    const open = stations.filter((station) => station.open).length;
    $('stations-sum').textContent = tr`${open} of ${stations.length} open`;
  }

  /** It is `now` [s], simulated. */
  tick(now) {
    this.now = now;
    for (const row of this.rows.values()) row.tick(now);
  }
}

/** One that stays where it is: a finger may be on its way to a button. */
class Row {
  constructor(act) {
    this.choice = new Choice();
    this.name = make('strong');
    this.kind = make('span', { className: 'dim' });
    this.state = make('span', { className: 'badge' });
    this.waits = make('div', { className: 'waits-text' });
    this.queue = make('div', { className: 'queue' });
    [this.orders, this.rate, this.busy] = [tr`orders`, tr`pieces/h`, tr`busy`].map((label) => cell('number right', label));
    this.gate = make('button', { className: 'edged', click: () => act(this.set(!this.station.open, this.station.mode)) });
    this.hand = make('button', { className: 'edged', click: () => act(this.set(this.station.open,
      this.isByHand ? StationMode.AUTOMATIC : StationMode.MANUAL)) });
    this.screen = make('a', { className: 'button edged', textContent: tr`Screen` });
    const title = make('th', { scope: 'row' }, this.name, this.kind);
    const does = make('td', { className: 'does' }, this.state);
    this.element = make('tr', {}, title, does, make('td', { className: 'who' }, this.waits, this.queue),
      this.orders, this.rate, this.busy, make('td', { className: 'acts' }, this.gate, this.hand, this.screen));
  }

  get isByHand() {
    return this.station.mode === StationMode.MANUAL;
  }

  /** Each button sends both: until the server has one, the other waits. */
  set(open, mode) {
    return whileBusy([this.gate, this.hand], async () => {
      const answer = await put(`/stations/${this.station.name}`, { open, mode, by: knownPerson() });
      this.choice.note({ open, mode }, performance.now());
      this.show(this.station, this.now);
      return answer;
    });
  }

  show(newest, now) {
    const before = this.station, station = this.choice.upon(newest, performance.now());
    this.station = station;
    this.tick(now);
    if (JSON.stringify(before) === JSON.stringify(station)) return;
    const { name, kind, open, activity } = station, picks = kind === 'PICK';
    this.name.textContent = name;
    this.kind.textContent = picks ? tr`picking` : tr`replenishing`;
    this.element.className = open ? 'station' : 'station shut';
    this.element.dataset.station = name;
    this.state.className = `badge ${ACTIVITY_CLASS[ACTIVITY_NAMES.indexOf(activity)] ?? ''}`;
    this.state.textContent = !open && activity === 'RESTING' ? tr`closed` : STATION_STATES[activity];
    this.orders.lastChild.textContent = picks ? tr`${station.orders.length} of ${station.slots}` : '–';
    this.rate.lastChild.textContent = number(station.pieces_per_hour);
    this.busy.lastChild.textContent = percent(station.busy_fraction);
    this.gate.textContent = open ? tr`Close` : tr`Open`;
    this.hand.textContent = tr`Manual`;
    press(this.hand, this.isByHand);
    this.hand.title = this.isByHand ? tr`A person works here; press for automatic` : tr`It works automatically; press for a person at its screen`;
    for (const button of [this.gate, this.hand]) button.ariaLabel = `${button.textContent}: ${name}`;
    this.screen.href = `${ROOT}/station/${encodeURIComponent(name)}`;
    this.screen.ariaLabel = tr`Screen of ${name}, for a person there`;
    this.showQueue(station.queue);
  }

  showQueue(queue) {
    const more = queue.length - CHIPS;
    this.queue.replaceChildren(...queue.slice(0, CHIPS).map(chip), ...more > 0 ? [make('span', { className: 'dim', textContent: tr`and ${more} more` })] : []);
  }

  tick(now) {
    this.now = now;
    const [text, look] = waitsOf(this.station, now);
    this.waits.textContent = text;
    this.waits.className = `waits-text ${look}`;
  }
}

/** A cell that a narrow page shows with its label. */
function cell(className, label) {
  return make('td', { className }, make('span', { className: 'label dim', textContent: label }), make('span'));
}

function chip({ unit, robot, stands, is_long: isLong }) {
  const waits = robot && stands >= 10;
  const title = robot ? tr`unit ${unit} on kiva${robot}${waits ? tr`, which has stood for ${lasting(stands)}` : tr`, under way`}` : tr`unit ${unit}: a robot is on its way to it`;
  const out = make('span', { className: isLong ? 'chip is-long' : robot ? 'chip' : 'chip is-far', title, textContent: waits ? `${unit} · ${lasting(stands)}` : `${unit}` });
  return out;
}
