// SPDX-License-Identifier: Apache-2.0
// What the page asks its own server, below /whatif.

import { reasonOf } from '../api.js';

/** The answer's body; throws an Error with the reason, `away` if there is no answer. */
export async function ask(method, path, body = undefined) {
  let answer;
  try {
    const sent = body && { body: JSON.stringify(body), headers: { 'content-type': 'application/json' } };
    answer = await fetch(`/whatif${path}`, { method, ...sent });
  } catch (error) {
    throw Object.assign(new Error('the server does not answer', { cause: error }), { away: true });
  }
  const told = await answer.json().catch(() => ({}));
  if (answer.ok) return told;
  throw new Error(reasonOf(told.detail) || `the server failed: ${answer.status}`);
}

export const pathOf = (name, rest = '') => `/scenarios/${encodeURIComponent(name)}${rest}`;

/** The query that names scenarios. */
export const queryOf = (names) => names.map((name) => `name=${encodeURIComponent(name)}`).join('&');
