// SPDX-License-Identifier: Apache-2.0
// The fleet that a coordinator drives, at a glance; nothing where none runs.

import { AlarmVoice } from '../base/alarm_voice.js';
import { $, keepRows, make, setText } from '../base/dom.js';
import { RobotMode } from '../base/message_enums.js';
import { number as figure } from '../language/numbers.js';
import { plural, tr } from '../language/texts.js';
import { lasting } from '../base/time.js';
import { counted, countedWork } from '../base/words.js';

const MOST_WAITING = 50; // rows

/** What a CoordinatorState counts, as [what, text]. */
export function factsOf({ robots, work, transports, executed_over_planned: executed, ...state }) {
  return [
    [tr`robots`, counted(robots)],
    [tr`at work`, countedWork(work)],
    [tr`transports`, tr`${transports.open} open, ${transports.under_way} under way`],
    [tr`completed`, tr`${transports.delivered} delivered, ${transports.stored} stored`
      + (transports.failed ? tr`, ${transports.failed} failed` : '')],
    [tr`planning time`, tr`median ${figure(state.plan_p50, 1)} ms, p99 ${figure(state.plan_p99, 1)} ms`],
    [tr`driven / planned time`, figure(executed, 2)],
    [tr`incidents`, incidentsOf(state)],
  ];
}

/** '2 collisions, 1 stop before an obstacle, 20 times without progress'; 'nothing'. */
function incidentsOf({ collisions, blocked, watchdog }) {
  return [collisions && plural(collisions, '{n} collision', '{n} collisions'), blocked && plural(blocked, '{n} stop before an obstacle', '{n} stops before an obstacle'),
    watchdog && plural(watchdog, '{n} time without progress', '{n} times without progress')].filter(Boolean).join(', ') || tr`nothing`;
}

export class FleetPanel {
  /** `select(name)` is called for a robot that was clicked. */
  constructor(select) {
    Object.assign(this, { select, fleet: null, byCause: null, alarms: null });
    this.voice = new AlarmVoice((text) => { $('alarm-told').textContent = text; });
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
    const waiting = fleet.waiting.slice(0, MOST_WAITING);
    keepRows($('waiting'), waiting, { keyOf: ({ robot }) => robot, create: ({ robot }) => this.row(robot), show: (row, waits) => setText(row, this.textOf(waits)) });
    $('waiting-title').hidden = waiting.length === 0;
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
    if (alarms) this.voice.take(alarms);
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

  row(robot) {
    return make('button', { click: () => this.select(`kiva${robot}`) });
  }

  textOf({ robot, since, text: reason }) {
    return tr`kiva${robot} waits ${reason}, for ${lasting(this.fleet.time - since)}`;
  }

  /** Who commands a robot, by its id; null where no coordinator runs. */
  modeOf(id) {
    if (!this.fleet) return null;
    if (this.fleet.manual.includes(id)) return RobotMode.MANUAL;
    return this.fleet.out_of_service.includes(id) ? RobotMode.OUT_OF_SERVICE : RobotMode.AUTOMATIC;
  }
}
