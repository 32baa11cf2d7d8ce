// SPDX-License-Identifier: Apache-2.0
// The fleet that a coordinator drives, at a glance; nothing where none runs.

import { $, make } from '../base/dom.js';
import { EventKind, RobotMode } from '../base/message_enums.js';
import { counted, countedEvents, countedWork } from '../base/words.js';

const MOST_WAITING = 50; // rows

/** What a CoordinatorState counts, as [what, text]. */
export function factsOf({ robots, work, transports, executed_over_planned: executed, ...state }) {
  return [
    ['robots', counted(robots)],
    ['at work', countedWork(work)],
    ['transports', `${transports.open} open, ${transports.under_way} under way`],
    ['completed', `${transports.delivered} delivered, ${transports.stored} stored`
      + (transports.failed ? `, ${transports.failed} failed` : '')],
    ['planning time', `median ${state.plan_p50.toFixed(1)} ms, p99 ${state.plan_p99.toFixed(1)} ms`],
    ['driven / planned time', executed.toFixed(2)],
    ['incidents', countedEvents({
      [EventKind.COLLISION]: state.collisions, [EventKind.BLOCKED]: state.blocked, watchdog: state.watchdog })],
  ];
}

export class FleetPanel {
  /** `select(name)` is called for a robot that was clicked. */
  constructor(select) {
    Object.assign(this, { select, fleet: null });
  }

  get runs() {
    return Boolean(this.fleet);
  }

  /** Takes the server's state of the coordinator; null: none runs. */
  take(fleet) {
    this.fleet = fleet;
    document.body.classList.toggle('coordinated', this.runs);
    for (const id of ['fleet-panel', 'fleet-tab', 'ways', 'heat']) $(id).hidden = !fleet;
    if (!fleet) return;
    $('fleet-facts').replaceChildren(...factsOf(fleet).flatMap(([what, text]) => [
      make('dt', { textContent: what }), make('dd', { textContent: text })]));
    $('alarms').replaceChildren(...fleet.alarms.map((text) => make('li', { textContent: text })));
    $('alarms').hidden = fleet.alarms.length === 0;
    const rows = fleet.waiting.slice(0, MOST_WAITING).map((waits) => this.row(waits));
    $('waiting').replaceChildren(...rows);
    $('waiting-title').hidden = rows.length === 0;
  }

  row({ robot, since, text: reason }) {
    const seconds = Math.round(this.fleet.time - since);
    const text = `kiva${robot} ${reason}, ${seconds} s`;
    return make('button', { textContent: text, click: () => this.select(`kiva${robot}`) });
  }

  /** Who commands a robot, by its id; null where no coordinator runs. */
  modeOf(id) {
    if (!this.fleet) return null;
    if (this.fleet.manual.includes(id)) return RobotMode.MANUAL;
    return this.fleet.out_of_service.includes(id) ? RobotMode.OUT_OF_SERVICE : RobotMode.AUTOMATIC;
  }
}
