// SPDX-License-Identifier: Apache-2.0
// The HTTP API; see /api/docs.

import { ask } from './request.js';

/** Each returns the answer's body, and throws an Error with the reason; `refused` if it was the
 *  warehouse's. */
export function post(path, body = undefined) {
  return request('POST', path, body);
}

export function get(path) {
  return request('GET', path);
}

export function put(path, body) {
  return request('PUT', path, body);
}

export function patch(path, body) {
  return request('PATCH', path, body);
}

export function remove(path) {
  return request('DELETE', path);
}

let forbidden = ''; // why nothing is commanded

/** Refuses every command from now on, for a reason; '': it is over. */
export function forbid(reason) {
  forbidden = reason;
}

async function request(method, path, body) {
  if (forbidden && method !== 'GET') throw Object.assign(new Error(forbidden), { refused: true });
  try {
    return await ask(method, `/api/v1${path}`, body);
  } catch (error) {
    throw Object.assign(error, { refused: error.status === 409 });
  }
}

/** A server that asks for a token shows a form for it in place of the page. */
export async function reloadIfLockedOut() {
  const answer = await fetch('/web/icon.svg', { method: 'HEAD' }).catch(() => null);
  if (answer?.status === 401) location.reload();
}

/** Sends a robot a command; the answer: {outcome, events}. */
export function command(id, name, fields) {
  return post(`/robots/${id}/commands?wait=end&timeout=120`, { command: name, ...fields });
}
