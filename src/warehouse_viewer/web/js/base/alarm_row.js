// SPDX-License-Identifier: Apache-2.0
// The row of an alarm: cause, consequences, remedies, and who has seen it.

import { make, whileBusy } from './dom.js';
import { ROOT } from './root.js';
import { tr } from '../language/texts.js';
import { lasting } from './time.js';
import { shownName } from './words.js';

/** The classes that give the severities their colours. */
const LOOKS = { critical: 'needs-help', warning: 'waiting', note: 'resting' };
const LINKS = ['SHOW', 'MOMENT']; // remedies that lead to the floor

/** One that stays where it is: a finger may be on its way to the button. */
export class AlarmRow {
  /** `see(alarm, isSeen)` and `apply(alarm, remedy)` are asked for by a person. */
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
    const name = text.startsWith(subject) || text === subject ? title : `${title}: ${shownName(subject)}`;
    const key = JSON.stringify([alarm.text, consequences, remedies, severity, by]);
    this.tick(now);
    if (key === this.key) return;
    this.key = key;
    this.element.className = `alarm ${LOOKS[severity]}${by ? ' is-seen' : ''}`;
    this.element.dataset.alarm = alarm.kind;
    this.title.textContent = name;
    this.text.textContent = shownName(text);
    this.toDo.textContent = alarm.to_do;
    this.toDo.hidden = remedies.some(({ action }) => !LINKS.includes(action)); // the buttons say it
    this.follows.replaceChildren(...consequences.map((consequence) => make('li', { textContent: shownName(consequence) })));
    this.follows.hidden = !consequences.length;
    this.showRemedies(remedies, alarm.since);
    this.button.textContent = by ? tr`Not mine` : tr`Seen`;
    this.button.ariaLabel = by ? tr`Take back that ${by} has seen: ${name}` : tr`I have seen: ${name}`;
    this.button.hidden = !id;
    this.tick(now);
  }

  showRemedies(remedies, since) {
    const key = JSON.stringify([remedies, since]);
    if (key === this.shownRemedies) return; // a finger may be on its way to one
    this.shownRemedies = key;
    this.remedies.replaceChildren(...remedies.map((remedy) => {
      const { action, label, target } = remedy;
      const about = { className: 'button edged', textContent: label, ariaLabel: `${label}: ${shownName(target)}` };
      const name = /^[a-z]+_?[a-z]*\d+$/i.test(target) ? target : '';
      if (action === 'MOMENT') return make('a', { ...about, href: `${ROOT}/#t=${since.toFixed(1)}${name ? `&see=${name}` : ''}` });
      if (action === 'SHOW') return make('a', { ...about, href: `${ROOT}/#${encodeURIComponent(target)}` });
      const button = make('button', { ...about, type: 'button', className: 'edged', click: () => whileBusy([button], () => this.apply(this.alarm, remedy)) });
      return button;
    }));
  }

  tick(now) {
    const { since, seen_by: by, seen_at: at } = this.alarm;
    this.since.textContent = since ? tr`for ${lasting(now - since)}` : '';
    this.seenBy.textContent = by ? tr`seen by ${by}, ${lasting(now - at)} ago` : tr`seen by no one yet`;
  }
}
