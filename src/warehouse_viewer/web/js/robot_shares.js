// SPDX-License-Identifier: Apache-2.0
// How many robots do what for the coordinator, and which of them wait.

import { $, make } from './dom.js';
import { lasting } from './time.js';
import { spaced } from './words.js';

/** The activity that each kind of work counts as: its colour. */
const LOOKS = { fetching: 'moving', bringing: 'moving', storing: 'moving', lifting: 'working', dropping: 'working', waiting: 'working',
  ready: 'waiting', idle: 'resting', manual: 'needs-help', out_of_service: 'needs-help' };
/** Work of which the name says too little. */
const TEXTS = { waiting: 'at a station', ready: 'ready beneath a unit' };
const MOST_WAITS = 6;

const text = (name) => TEXTS[name] ?? spaced(name);

export class RobotShares {
  /** `fleet` as the server tells it; null without a coordinator. */
  show(fleet) {
    $('fleet').textContent = fleet ? '' : 'no coordinator runs';
    if (!fleet) return;
    const { manual, out_of_service } = fleet.robots;
    const doing = { ...fleet.work, manual, out_of_service };
    const shown = Object.keys(LOOKS).filter((name) => doing[name]);
    $('robots').replaceChildren(...shown.map((name) => {
      const bar = make('div', { className: LOOKS[name], title: `${doing[name]} ${text(name)}` });
      bar.style.flex = doing[name];
      return bar;
    }));
    $('robots-legend').replaceChildren(...shown.map((name) => (
      make('li', {}, make('i', { className: `key ${LOOKS[name]}` }), make('b', { textContent: doing[name] }), ` ${text(name)}`))));
    const { transports } = fleet;
    $('fleet').textContent = `${transports.under_way} transports under way, ${transports.open} open; a plan takes ${fleet.plan_p50.toFixed(1)} ms`;
    this.showWaits(fleet);
  }

  showWaits({ waiting, time }) {
    const more = waiting.length - MOST_WAITS;
    const longest = [...waiting].sort((a, b) => a.since - b.since).slice(0, MOST_WAITS);
    $('waiting').replaceChildren(...longest.map(({ robot, since, text: why }) => (
      make('li', {}, make('a', { href: `/#kiva${robot}`, textContent: `kiva${robot}` }), ` waits ${lasting(time - since)} ${why}`))),
    ...more > 0 ? [make('li', { className: 'dim', textContent: `and ${more} more` })] : []);
  }
}
