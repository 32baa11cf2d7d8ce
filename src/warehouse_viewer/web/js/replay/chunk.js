// SPDX-License-Identifier: Apache-2.0
// Reads a chunk of a recording, as replay/chunk.py writes it.

import { decode } from '../base/protocol.js';
import { tr } from '../language/texts.js';

const UPDATE = 1, TEXT = 4, HEAD = 16;

/** The updates of a chunk, as decode() has them, and its texts, {stamp, message}; both in their order.
 *  Throws an Error where a message is cut off. */
export function read(buffer) {
  const view = new DataView(buffer), out = { updates: [], texts: [] };
  for (let at = 0; at < buffer.byteLength;) {
    const [kind, begin, length] = headAt(view, at);
    const data = buffer.slice(begin, begin + length);
    if (kind === UPDATE) out.updates.push(decode(data));
    else if (kind === TEXT) out.texts.push({ stamp: view.getFloat64(at + 8, true), message: parsed(data) });
    at = begin + 8 * Math.ceil(length / 8);
  }
  return out;
}

/** [kind, where the message begins, its length]. */
function headAt(view, at) {
  const whole = at + HEAD <= view.byteLength;
  const length = whole ? view.getUint32(at + 4, true) : 0;
  if (!whole || at + HEAD + length > view.byteLength) throw new Error(tr`the recording is damaged: byte ${at} of a chunk`);
  return [view.getUint32(at, true), at + HEAD, length];
}

function parsed(data) {
  return JSON.parse(new TextDecoder().decode(data));
}
