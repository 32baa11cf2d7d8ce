// SPDX-License-Identifier: Apache-2.0
// What a station waits for, in the same words wherever one asks.

import { lasting } from './time.js';

const UNATTENDED = 60; // [s], simulated

/** [what a station waits for and for how long, the class of how bad that is] at `now` [s]. */
export function waitsOf({ waiting, shelf_id: unit, since, queue, activity, open, orders, why }, now) {
  const next = queue?.[0]?.unit, span = lasting(Math.max(0, now - since));
  if (waiting) return [`unit ${unit} has waited for a person for ${lasting(waiting)}`, waiting >= UNATTENDED ? 'is-bad' : ''];
  if (unit) return [`unit ${unit} is there, for ${span}`, ''];
  if (next && why) return [`${why}, for ${span}`, activity === 'WAITING' ? 'is-long' : '']; // the server's sentence
  if (next) return [`waits for unit ${next}, for ${span}`, activity === 'WAITING' ? 'is-long' : ''];
  if (open && orders?.length) return [`waits for a unit, for ${span}`, activity === 'WAITING' ? 'is-long' : ''];
  return ['', ''];
}
