// SPDX-License-Identifier: Apache-2.0
// The fleet that a coordinator drives, at a glance; nothing where none runs.

import { $, make, setText } from '../base/dom.js';
import { RobotMode } from '../base/message_enums.js';
import { counted as number, number as figure } from '../base/numbers.js';
import { lasting } from '../base/time.js';
import { counted, countedWork } from '../base/words.js';

const MOST_WAITING = 50; // rows

/** What a CoordinatorState counts, as [what, text]. */
export function factsOf({ robots, work, transports, executed_over_planned: executed, ...state }) {
  return [
    ['robots', counted(robots)],
    ['at work', countedWork(work)],
    ['transports', `${transports.open} open, ${transports.under_way} under way`],
    ['completed', `${transports.delivered} delivered, ${transports.stored} stored`
      + (transports.failed ? `, ${transports.failed} failed` : '')],
    ['planning time', `median ${figure(state.plan_p50, 1)} ms, p99 ${figure(state.plan_p99, 1)} ms`],
    ['driven / planned time', figure(executed, 2)],
    ['incidents', incidentsOf(state)],
  ];
}

/** '2 collisions, 1 stop before an obstacle, 20 times without progress'; 'nothing'. */
function incidentsOf({ collisions, blocked, watchdog }) {
  return [collisions && number(collisions, 'collision'), blocked && `${number(blocked, 'stop')} before an obstacle`,
    watchdog && `${number(watchdog, 'time')} without progress`].filter(Boolean).join(', ') || 'nothing';
}

export class FleetPanel {
  /** `select(name)` is called for a robot that was clicked. */
  constructor(select) {
    Object.assign(this, { select, fleet: null, byCause: null, alarms: null });
  }

  get runs() {
    return Boolean(this.fleet);
  }

  /** Takes the server's state of the coordinator; null: none runs. */
  take(fleet) {
    this.fleet = fleet;
    document.body.classList.toggle('coordinated', this.runs);
    for (const id of ['fleet-panel', 'fleet-tab', 'ways', 'heat', 'zone']) $(id).hidden = !fleet;
    if (!fleet) return;
    $('fleet-facts').replaceChildren(...factsOf(fleet).flatMap(([what, text]) => [
      make('dt', { textContent: what }), make('dd', { textContent: text })]));
    if (!this.alarms) this.showSentences(fleet.alarms);
    else this.byCause?.tick(fleet.time);
    const rows = fleet.waiting.slice(0, MOST_WAITING).map((waits) => this.row(waits));
    $('waiting').replaceChildren(...rows);
    $('waiting-title').hidden = rows.length === 0;
  }

  /** What the coordinator says, where nothing joins it by cause: in a recording. */
  showSentences(texts) {
    $('alarms').classList.remove('by-cause');
    $('alarms').replaceChildren(...texts.map((text) => make('li', { textContent: text })));
    $('alarms').hidden = texts.length === 0;
  }

  /** The server's alarms, by cause; null: it has none, as in a recording. */
  async takeAlarms(alarms) {
    this.alarms = alarms;
    const count = alarms?.length ?? 0;
    $('alarm-number').hidden = !count;
    setText($('alarm-number'), String(count));
    if (count || (alarms && this.byCause)) await this.showCauses();
    else this.showSentences(alarms ? [] : this.fleet?.alarms ?? []);
  }

  async showCauses() {
    const { AlarmPanel } = await import('./alarm_panel.js');
    if (!this.alarms) return; // the past is shown meanwhile
    this.byCause ??= new AlarmPanel(this.select);
    this.byCause.take(this.alarms, this.fleet?.time ?? 0);
  }

  row({ robot, since, text: reason }) {
    const text = `kiva${robot} waits ${reason}, for ${lasting(this.fleet.time - since)}`;
    return make('button', { textContent: text, click: () => this.select(`kiva${robot}`) });
  }

  /** Who commands a robot, by its id; null where no coordinator runs. */
  modeOf(id) {
    if (!this.fleet) return null;
    if (this.fleet.manual.includes(id)) return RobotMode.MANUAL;
    return this.fleet.out_of_service.includes(id) ? RobotMode.OUT_OF_SERVICE : RobotMode.AUTOMATIC;
  }
}
