// SPDX-License-Identifier: Apache-2.0
// What the page asks its own server, below /layout.

import * as server from '../base/request.js';

/** The answer's body; throws an Error with the reason. */
export function ask(method, path, body = undefined) {
  return server.ask(method, `/layout${path}`, body);
}

/** The response itself, if it is a good one. */
export function send(method, path, body, signal) {
  return server.send(method, `/layout${path}`, body, signal);
}
