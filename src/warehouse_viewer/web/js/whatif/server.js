// SPDX-License-Identifier: Apache-2.0
// What the page asks its own server, below /whatif.

import * as server from '../base/request.js';

/** The answer's body; throws an Error with the reason. */
export function ask(method, path, body = undefined) {
  return server.ask(method, `/whatif${path}`, body);
}

export const pathOf = (name, rest = '') => `/scenarios/${encodeURIComponent(name)}${rest}`;

/** The query that names scenarios. */
export const queryOf = (names) => names.map((name) => `name=${encodeURIComponent(name)}`).join('&');
