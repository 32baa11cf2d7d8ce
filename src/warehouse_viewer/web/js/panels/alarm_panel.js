// SPDX-License-Identifier: Apache-2.0
// The alarms by cause, on the floor's page: consequences, remedies, and who has seen each.

import { AlarmRow } from '../base/alarm_row.js';
import { post } from '../base/api.js';
import { $, arrange, make } from '../base/dom.js';
import { knownPerson, personOf } from '../base/person.js';
import { tr } from '../language/texts.js';

export class AlarmPanel {
  /** `select(name)` is called for what an alarm shows on the floor. */
  constructor(select) {
    Object.assign(this, { select, rows: new Map() });
    this.answer = make('p', { className: 'answer', hidden: true });
    this.answer.setAttribute('role', 'status');
    $('alarms').after(this.answer);
    document.head.append(make('link', { rel: 'stylesheet', href: '/web/alarms.css' }));
  }

  /** All alarms of the server, at a time [s]. */
  take(alarms, now) {
    const kept = this.rows;
    this.rows = new Map(alarms.map((alarm) => [alarm.id, kept.get(alarm.id) ?? this.row()]));
    for (const alarm of alarms) this.rows.get(alarm.id).show(alarm, now);
    arrange($('alarms'), [...this.rows.values()].map(({ element }) => element));
    $('alarms').hidden = !alarms.length;
    $('alarms').classList.add('by-cause');
  }

  row() {
    const out = new AlarmRow((alarm, isSeen) => this.see(alarm, isSeen), (alarm, remedy) => this.apply(alarm, remedy));
    // What is shown on the floor is here: no other page opens.
    out.element.addEventListener('click', (event) => {
      if (!event.target.closest('a')?.href.endsWith(`#${encodeURIComponent(out.alarm.subject)}`)) return;
      event.preventDefault();
      this.select(out.alarm.subject);
    });
    return out;
  }

  /** It is `now` [s], simulated. */
  tick(now) {
    for (const row of this.rows.values()) row.tick(now);
  }

  /** Marks an alarm as seen on all pages, or as not seen. */
  async see(alarm, isSeen) {
    const by = isSeen ? await personOf() : '';
    if (!isSeen || by) await this.sent(() => post(`/alarms/${alarm.id}/seen`, { by }));
  }

  /** Has the server do what a button says; it notes who asked for it. */
  async apply(alarm, { action, label, target }) {
    await this.sent(() => post(`/alarms/${alarm.id}/remedies/${action}`, { by: knownPerson() }), `${label}, ${target}: `);
  }

  async sent(request, what = '') {
    try {
      const { message } = await request();
      this.say(what && `${what}${message || tr`done`}`, 'done');
    } catch (error) {
      this.say(`${what}${error.message}`, 'refused');
    }
  }

  say(text, kind) {
    Object.assign(this.answer, { hidden: !text, textContent: text });
    this.answer.dataset.kind = kind;
  }
}
