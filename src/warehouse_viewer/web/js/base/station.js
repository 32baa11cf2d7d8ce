// SPDX-License-Identifier: Apache-2.0
// What a station waits for, in the same words on all pages; and what a person has just set there.

import { tr } from '../language/texts.js';
import { lasting } from './time.js';

const UNATTENDED = 60; // [s], simulated
const HOLDS = 5000; // [ms] after which the server has surely sent what was set

/** [what a station waits for and for how long, the class of how bad that is] at `now` [s]. */
export function waitsOf({ waiting, shelf_id: unit, since, queue, activity, open, orders, why }, now) {
  const next = queue?.[0]?.unit, span = lasting(Math.max(0, now - since));
  if (waiting) return [tr`unit ${unit} has waited for a person for ${lasting(waiting)}`, waiting >= UNATTENDED ? 'is-bad' : ''];
  if (unit) return [tr`unit ${unit} is there, for ${span}`, ''];
  const text = reasonOf(next, why, open && orders?.length);
  return text ? [tr`${text}, for ${span}`, activity === 'WAITING' ? 'is-long' : ''] : ['', ''];
}

/** The server's sentence while a unit is to come, or what is known without it. */
function reasonOf(next, why, hasWork) {
  if (next) return why || tr`waits for unit ${next}`;
  return hasWork ? tr`waits for a unit` : '';
}

/** What was set last. It counts until the server sends it: a state that comes before may be older. */
export class Choice {
  /** `choice` is {open, mode}; it was set at `now` [ms]. */
  note(choice, now) {
    Object.assign(this, { choice, until: now + HOLDS });
  }

  /** A station's state of `now` [ms] from the server, with what was set. */
  upon(station, now) {
    const { open, mode } = this.choice ?? station;
    if (now >= this.until || (station.open === open && station.mode === mode)) this.choice = undefined;
    return { ...station, ...this.choice };
  }
}
