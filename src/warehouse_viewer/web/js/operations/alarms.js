// SPDX-License-Identifier: Apache-2.0
// The alarms, the worst first: since when each holds, its cause, what to do, and the person that saw it.

import { post } from '../base/api.js';
import { $, make, on } from '../base/dom.js';
import { personOf } from '../base/person.js';
import { ROOT } from '../base/root.js';
import { lasting } from '../base/time.js';

const TITLE = document.title;
/** The classes that give the severities their colours. */
const LOOKS = { critical: 'needs-help', warning: 'waiting', note: 'resting' };
/** The alarm that only the page itself can raise. */
const AWAY = { id: 0, kind: 'CONNECTION', severity: 'critical', title: 'No connection', subject: 'server', text: '',
  to_do: 'What is shown is old. The page comes back by itself; if not, look whether the node `viewer` runs.', since: 0, seen_by: '', seen_at: 0 };
const LINKS = ['SHOW', 'MOMENT']; // remedies that lead to the floor

export class Alarms {
  /** `fail(error)` where the server refuses. */
  constructor(fail) {
    Object.assign(this, { fail, alarms: [], away: null, now: 0, rows: new Map() });
    on($('person'), 'click', () => this.ask());
    on($('alarm-past'), 'toggle', () => this.showPast());
    this.showPerson();
  }

  /** All alarms of the server. */
  take(alarms) {
    const known = new Set(this.alarms.map(({ id }) => id));
    const [fresh] = alarms.filter(({ id }) => !known.has(id));
    this.alarms = alarms;
    if (fresh) $('alarm-told').textContent = `Alarm: ${fresh.title}. ${fresh.text}. ${fresh.to_do}`;
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
    this.rows = new Map(all.map((alarm) => [alarm.id, kept.get(alarm.id) ?? new Row((chosen, by) => this.see(chosen, by), (chosen, remedy) => this.apply(chosen, remedy))]));
    all.forEach((alarm) => this.rows.get(alarm.id).show(alarm, this.now));
    const elements = [...this.rows.values()].map(({ element }) => element);
    if (elements.some((element, i) => $('alarms').children[i] !== element) || $('alarms').children.length !== elements.length) {
      $('alarms').replaceChildren(...elements);
    }
    const unseen = all.filter(({ seen_by: by }) => !by).length;
    if ($('alarm-past').open && all.length !== this.count) this.showPast();
    this.count = all.length;
    $('no-alarms').hidden = all.length > 0;
    $('alarm-count').textContent = all.length ? `${all.length}, ${unseen} not seen` : '';
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
      await post(`/alarms/${alarm.id}/remedies/${action}`, { by: localStorage.getItem('person') ?? '' });
      $('alarm-told').textContent = `${label}: ${target}, done.`;
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
    const name = localStorage.getItem('person');
    $('person').textContent = name ? `You are ${name}` : 'Who are you?';
  }
}

/** One that stays where it is: a finger may be on its way to the button. */
class Row {
  constructor(see, apply) {
    this.apply = apply;
    this.follows = make('ul', { className: 'follows' });
    this.remedies = make('div', { className: 'remedies' });
    this.title = make('strong');
    this.since = make('span', { className: 'since dim' });
    this.text = make('p');
    this.toDo = make('p', { className: 'to-do dim' });
    this.seenBy = make('span', { className: 'seen dim' });
    this.button = make('button', { className: 'edged', click: () => see(this.alarm, !this.alarm.seen_by) });
    this.element = make('li', {}, make('header', {}, this.title, this.since), this.text, this.follows, this.toDo, this.remedies, make('footer', {}, this.seenBy, this.button));
  }

  show(alarm, now) {
    this.alarm = alarm;
    const { severity, title, subject, cause: text = alarm.text, consequences = [], remedies = [], seen_by: by, id } = alarm;
    const name = text.startsWith(subject) || text === subject ? title : `${title}: ${subject}`;
    const key = JSON.stringify([alarm.text, consequences, remedies, severity, by]);
    this.tick(now);
    if (key === this.key) return;
    this.key = key;
    this.element.className = `alarm ${LOOKS[severity]}${by ? ' is-seen' : ''}`;
    this.element.dataset.alarm = alarm.kind;
    this.title.textContent = name;
    this.text.textContent = text;
    this.toDo.textContent = alarm.to_do;
    this.toDo.hidden = remedies.some(({ action }) => !LINKS.includes(action)); // the buttons say it
    this.follows.replaceChildren(...consequences.map((textContent) => make('li', { textContent })));
    this.follows.hidden = !consequences.length;
    this.showRemedies(remedies, alarm.since);
    this.button.textContent = by ? 'Not mine' : 'Seen';
    this.button.ariaLabel = by ? `Take back that ${by} has seen: ${name}` : `I have seen: ${name}`;
    this.button.hidden = !id;
    this.tick(now);
  }

  showRemedies(remedies, since) {
    const key = JSON.stringify([remedies, since]);
    if (key === this.shownRemedies) return; // a finger may be on its way to one
    this.shownRemedies = key;
    this.remedies.replaceChildren(...remedies.map((remedy) => {
      const { action, label, target } = remedy;
      const about = { className: 'button edged', textContent: label, ariaLabel: `${label}: ${target}` };
      const name = /^[a-z]+_?[a-z]*\d+$/i.test(target) ? target : '';
      if (action === 'MOMENT') return make('a', { ...about, href: `${ROOT}/#t=${since.toFixed(1)}${name ? `&see=${name}` : ''}` });
      if (action === 'SHOW') return make('a', { ...about, href: `${ROOT}/#${encodeURIComponent(target)}` });
      const button = make('button', { ...about, type: 'button', className: 'edged', click: async () => {
        button.disabled = true;
        await this.apply(this.alarm, remedy);
        button.disabled = false;
      } });
      return button;
    }));
  }

  tick(now) {
    const { since, seen_by: by, seen_at: at } = this.alarm;
    this.since.textContent = since ? `for ${lasting(now - since)}` : '';
    this.seenBy.textContent = by ? `seen by ${by}, ${lasting(now - at)} ago` : 'seen by no one yet';
  }
}
