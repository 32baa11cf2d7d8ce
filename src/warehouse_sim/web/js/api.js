// SPDX-License-Identifier: Apache-2.0
// The HTTP API; see /docs.

/** The answer's body. Throws an Error with the reason; `refused` if it was the warehouse's. */
export async function post(path, body = undefined) {
  let answer;
  try {
    answer = await fetch(`/api/v1${path}`, {
      method: 'POST',
      headers: body ? { 'content-type': 'application/json' } : {},
      body: body && JSON.stringify(body),
    });
  } catch {
    throw new Error('the server does not answer');
  }
  const told = await answer.json().catch(() => ({}));
  if (answer.ok) return told;
  throw Object.assign(new Error(reasonOf(told.detail) || answer.statusText),
    { refused: answer.status === 409 });
}

function reasonOf(detail) {
  return Array.isArray(detail) ? detail.map((d) => `${d.loc.at(-1)}: ${d.msg}`).join('; ') : detail;
}

/** Sends a robot a command; the answer: {outcome, events}. */
export function command(id, name, fields) {
  return post(`/robots/${id}/commands?wait=end&timeout=120`, { command: name, ...fields });
}
