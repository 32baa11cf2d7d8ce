// SPDX-License-Identifier: Apache-2.0
// The alarms, the worst first: since when each holds, its cause, what to do, and the person that saw it.

import { AlarmRow } from '../base/alarm_row.js';
import { AlarmVoice } from '../base/alarm_voice.js';
import { post } from '../base/api.js';
import { $, arrange, on } from '../base/dom.js';
import { knownPerson, personOf } from '../base/person.js';
import { tr } from '../language/texts.js';

const TITLE = document.title;
/** The alarm that only the page itself can raise. */
const AWAY = { id: 0, kind: 'CONNECTION', severity: 'critical', title: tr`No connection`, subject: 'server', text: '',
  to_do: tr`What is shown is old. The page comes back by itself; if not, look whether the node \`viewer\` runs.`, since: 0, seen_by: '', seen_at: 0 };

export class Alarms {
  /** `fail(error)` where the server refuses. */
  constructor(fail) {
    Object.assign(this, { fail, alarms: [], away: null, now: 0, rows: new Map() });
    this.voice = new AlarmVoice((text) => { $('alarm-told').textContent = text; });
    on($('person'), 'click', () => this.ask());
    on($('alarm-past'), 'toggle', () => this.showPast());
    this.showPerson();
  }

  /** All alarms of the server. */
  take(alarms) {
    this.alarms = alarms;
    this.voice.take(alarms);
    this.draw();
  }

  /** The server is away, and why; '': it answers. */
  setAway(text) {
    this.away = text ? { ...AWAY, text, since: this.now } : null;
    this.draw();
  }

  /** It is `now` [s], simulated. */
  tick(now) {
    this.now = now;
    for (const row of this.rows.values()) row.tick(now);
  }

  draw() {
    const all = [...this.away ? [this.away] : [], ...this.alarms];
    const kept = this.rows;
    this.rows = new Map(all.map((alarm) => [alarm.id, kept.get(alarm.id) ?? new AlarmRow((chosen, by) => this.see(chosen, by), (chosen, remedy) => this.apply(chosen, remedy))]));
    all.forEach((alarm) => this.rows.get(alarm.id).show(alarm, this.now));
    arrange($('alarms'), [...this.rows.values()].map(({ element }) => element));
    const unseen = all.filter(({ seen_by: by }) => !by).length;
    if ($('alarm-past').open && all.length !== this.count) this.showPast();
    this.count = all.length;
    $('no-alarms').hidden = all.length > 0;
    $('alarm-count').textContent = all.length ? tr`${all.length}, ${unseen} not seen` : '';
    dispatchEvent(new CustomEvent('count', { detail: all.length })); // for the page's link
    document.title = all.length ? `(${all.length}) ${TITLE}` : TITLE;
  }

  /** Marks an alarm as seen on all pages, or as not seen. */
  async see(alarm, isSeen) {
    const by = isSeen ? await personOf() : '';
    if (isSeen && !by) return;
    this.showPerson();
    try {
      const changed = await post(`/alarms/${alarm.id}/seen`, { by });
      this.take(this.alarms.map((other) => (other.id === changed.id ? changed : other)));
    } catch (error) {
      this.fail(error);
    }
  }

  /** Has the server do what a button says; it notes who asked for it. */
  async apply(alarm, { action, label, target }) {
    try {
      await post(`/alarms/${alarm.id}/remedies/${action}`, { by: knownPerson() });
      $('alarm-told').textContent = tr`${label}: ${target}, done.`;
    } catch (error) {
      this.fail(new Error(`${label}, ${target}: ${error.message}`));
    }
  }

  /** The alarms that have ended, fetched on demand. */
  async showPast() {
    if (!$('alarm-past').open) return;
    const { showPast } = await import('./alarm_past.js');
    await showPast().catch(this.fail);
  }

  async ask() {
    await personOf(true);
    this.showPerson();
  }

  showPerson() {
    const name = knownPerson();
    $('person').textContent = name ? tr`You are ${name}` : tr`Who are you?`;
  }
}
