// SPDX-License-Identifier: Apache-2.0
// What a station waits for, in the same words wherever one asks.

import { lasting } from './time.js';

const UNATTENDED = 60; // [s], simulated

/** [what a station waits for and for how long, the class of how bad that is] at `now` [s]. */
export function waitsOf({ waiting, shelf_id: unit, since, queue, activity, open, orders, why }, now) {
  const next = queue?.[0]?.unit, span = lasting(Math.max(0, now - since));
  if (waiting) return [`unit ${unit} has waited for a person for ${lasting(waiting)}`, waiting >= UNATTENDED ? 'is-bad' : ''];
  if (unit) return [`unit ${unit} is there, for ${span}`, ''];
  const text = reasonOf(next, why, open && orders?.length);
  return text ? [`${text}, for ${span}`, activity === 'WAITING' ? 'is-long' : ''] : ['', ''];
}

/** The server's sentence while a unit is to come, or what is known without it. */
function reasonOf(next, why, hasWork) {
  if (next) return why || `waits for unit ${next}`;
  return hasWork ? 'waits for a unit' : '';
}
