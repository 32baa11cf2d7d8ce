// SPDX-License-Identifier: Apache-2.0
// Requests to the server of a page, in JSON.

import { at } from './root.js';
import { tr } from '../language/texts.js';

/** The response, if it is a good one; throws an Error with the reason, and with the `status`
 *  where there is an answer, and the `field` that it names. A text is sent as it is. */
export async function send(method, path, body = undefined, signal = undefined) {
  let answer;
  try {
    answer = await fetch(at(path), { method, signal, ...contentOf(method, body) });
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new Error(tr`the server does not answer`, { cause: error });
  }
  const { ok, status, statusText } = answer;
  if (ok) return answer;
  const { detail, field = '' } = await answer.json().catch(() => ({}));
  throw Object.assign(new Error(reasonOf(detail) || tr`the server failed: ${status} ${statusText}`.trim()), { status, field });
}

/** Headers and body of a request; one that changes something names the person. */
function contentOf(method, body) {
  const person = globalThis.localStorage?.getItem('person');
  const named = method !== 'GET' && person ? { 'x-person': encodeURIComponent(person) } : {};
  if (body === undefined) return { headers: named };
  return { body: typeof body === 'string' ? body : JSON.stringify(body), headers: { 'content-type': 'application/json', ...named } };
}

/** The body of the answer; throws as `send` does. */
export async function ask(method, path, body = undefined) {
  const answer = await send(method, path, body);
  return await answer.json().catch(() => ({}));
}

/** The reason in a refusal's body: a text, or a list of what is wrong with which field. */
export function reasonOf(detail) {
  return Array.isArray(detail) ? detail.map((d) => `${d.loc.at(-1)}: ${d.msg}`).join('; ') : detail;
}
