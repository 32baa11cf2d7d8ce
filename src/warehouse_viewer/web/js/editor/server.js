// SPDX-License-Identifier: Apache-2.0
// What the page asks its own server, below /layout.

import { reasonOf } from '../api.js';

/** The answer's body; throws an Error with the reason. */
export async function ask(path, body = undefined, method = 'POST') {
  const answer = await send(path, body && JSON.stringify(body), method);
  return await answer.json();
}

/** The response itself, if it is a good one. */
export async function send(path, body, method, signal = undefined) {
  let answer;
  try {
    const sent = body === undefined ? {} : { method, body, headers: { 'content-type': 'application/json' } };
    answer = await fetch(`/layout${path}`, { signal, ...sent });
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new Error('the server does not answer', { cause: error });
  }
  if (answer.ok) return answer;
  const told = await answer.json().catch(() => ({}));
  throw new Error(reasonOf(told.detail) || `the server failed: ${answer.status}`);
}
