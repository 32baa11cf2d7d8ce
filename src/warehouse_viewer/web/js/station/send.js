// SPDX-License-Identifier: Apache-2.0
// Sends what an Outbox keeps.

import { reloadIfLockedOut } from '../base/api.js';
import { reasonOf } from '../base/request.js';
import { ROOT } from '../base/root.js';
import { Refused } from './outbox.js';

const PATIENCE = 6000; // for an answer [ms]
const FINAL = [404, 409, 413, 422]; // statuses that a repetition would get, too

/** A function of an entry: {kind: 'report' | 'undo', sequence, body}; see Outbox. */
export function senderOf(station) {
  return async ({ kind, sequence, body }) => {
    const path = `${ROOT}/api/v1/stations/${encodeURIComponent(station)}/picks/${sequence}`;
    const sent = kind === 'undo' ? { method: 'DELETE' }
      : { method: 'POST', headers: { 'content-type': 'application/json' }, body: JSON.stringify(body) };
    const answer = await fetch(path, { ...sent, signal: AbortSignal.timeout(PATIENCE) });
    const reply = await answer.json();
    if (answer.ok) return reply;
    if (FINAL.includes(answer.status)) throw new Refused(reasonOf(reply.detail));
    if (answer.status === 401) reloadIfLockedOut();
    throw new Error(`${answer.status} ${answer.statusText}`);
  };
}
