// SPDX-License-Identifier: Apache-2.0
// The words for what the server tells in numbers and names: the same on every page, and those of the
// API and of the events (words.py); a test compares them.

/** What a robot does at a glance, by number: `holding` carries a storage unit and has no command,
 *  `blocked` ended its last command before an obstacle, and has no other one yet. */
export const ACTIVITY = ['idle', 'busy', 'blocked', 'holding'];
/** More closely, by number. */
export const STATE = ['stands', 'drives along x', 'drives along y', 'turns', 'lifts', 'blocked', 'waits for its turn'];
/** What is broken, by bit. */
export const FAILURE = ['battery empty', 'drive', 'lift stuck', 'laser blind', 'radio lost', 'wheels slip'];
/** What the coordinator has robots do, in the order of a transport; `idle` have no transport. */
export const WORK = ['fetching', 'ready', 'lifting', 'bringing', 'waiting', 'storing', 'dropping', 'idle'];
/** Who commands a robot. */
export const MODE = { AUTOMATIC: 'automatic', MANUAL: 'manual', OUT_OF_SERVICE: 'out of service' };
/** Kinds of events that a person may have to look after. */
export const TROUBLE = ['REFUSED', 'BLOCKED', 'COLLISION', 'FAILED', 'LOST', 'TIPPED', 'FELL'];
export const ORDER_STATES = { OPEN: 'open', ASSIGNED: 'at', COMPLETED: 'done', CANCELLED: 'cancelled' };

/** A name of several words, as in out_of_service. */
export function spaced(name) {
  return name.replaceAll('_', ' ');
}

/** {name: count} as '2 waiting, 1 out of service'. */
export function counted(counts, none = 'none') {
  return Object.entries(counts).filter(([, count]) => count > 0)
    .map(([name, count]) => `${count} ${spaced(name)}`).join(', ') || none;
}

/** {kind: count} of events so far, under the names that the log has for them. */
export function countedEvents(counts) {
  return Object.entries(counts).filter(([, count]) => count > 0)
    .map(([kind, count]) => `${count} × ${kind}`).join(', ') || 'nothing';
}
