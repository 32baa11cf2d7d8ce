// SPDX-License-Identifier: Apache-2.0
// What a screen reader hears of alarms: the worst of those that came, and how many came beside it. While it reads one
// alarm, further alarms wait, and one sentence announces them together: a hall that stops raises dozens.

import { plural, tr } from '../language/texts.js';

const QUIET = 8000; // from one to the next, at least [ms]

export class AlarmVoice {
  /** `say(text)` tells it. */
  constructor(say, later = (act, ms) => setTimeout(act, ms)) {
    Object.assign(this, { say, later, known: new Set(), untold: new Set(), alarms: [], isSpeaking: false });
  }

  /** All alarms there are now, the worst first. */
  take(alarms) {
    for (const { id } of alarms) if (!this.known.has(id)) this.untold.add(id);
    this.known = new Set(alarms.map(({ id }) => id));
    this.alarms = alarms;
    if (!this.isSpeaking) this.speak();
  }

  speak() {
    const [worst, ...others] = this.alarms.filter(({ id }) => this.untold.has(id)); // skips alarms that are over
    this.untold.clear();
    this.isSpeaking = Boolean(worst);
    if (!worst) return;
    const { title, text, to_do: toDo } = worst, more = others.length;
    this.say([tr`Alarm: ${title}. ${text}. ${toDo}`, more && plural(more, '{n} more alarm.', '{n} more alarms.')].filter(Boolean).join(' '));
    this.later(() => this.speak(), QUIET);
  }
}
