// SPDX-License-Identifier: Apache-2.0
// The WebSocket, which comes back by itself.

import { reloadIfLockedOut } from './api.js';
import { on } from './dom.js';
import { decode } from './protocol.js';
import { ROOT } from './root.js';
import { tr } from '../language/texts.js';

const RETRY = [500, 1000, 2000, 4000]; // [ms]
const FULL = 1013; // a WebSocket's close code: the server has as many pages as it takes
const NOTABLE = 0.2; // change of a gap, as a part of it

export class Connection {
  /** handlers: {update, scan, ways, scene, status, events, paths, fleet} for what comes, state(live, why not).
   *  `soon(act)` calls `act` when there is time for what came. */
  constructor(handlers, soon) {
    Object.assign(this, { handlers, soon });
    this.failures = 0;
    this.bytes = this.updates = 0; // of updates, since the start
    this.wishes = null;
    this.gap = 0; // between two updates, at least [s]
    this.isHeld = false;
    this.open();
  }

  open() {
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    const socket = this.socket = new WebSocket(`${scheme}://${location.host}${ROOT}/live`);
    const isOurs = () => socket === this.socket && !this.isHeld; // none that was left
    socket.binaryType = 'arraybuffer';
    on(socket, 'open', () => isOurs() && this.greet());
    on(socket, 'message', ({ data }) => this.soon(() => isOurs() && this.take(data)));
    on(socket, 'close', ({ code }) => isOurs() && this.again(code));
  }

  greet() {
    this.failures = 0;
    this.handlers.state(true);
    if (this.wishes) this.send({ watch: this.wishes });
    if (this.gap) this.send({ gap: this.gap });
  }

  /** Hears nothing until release(): the page shows something else. */
  hold() {
    this.isHeld = true;
    this.socket.close();
  }

  /** Begins again, with the whole scene. */
  release() {
    this.isHeld = false;
    this.open();
  }

  again(code) {
    this.handlers.state(false, code === FULL ? tr`too many pages are open` : tr`no connection`);
    reloadIfLockedOut();
    setTimeout(() => this.isHeld || this.open(), RETRY[Math.min(this.failures++, RETRY.length - 1)]);
  }

  take(data) {
    if (typeof data === 'string') {
      const message = JSON.parse(data);
      this.handlers[message.type](message);
      return;
    }
    this.bytes += data.byteLength;
    const message = decode(data);
    this.handlers[message.kind](message);
    // The server sends further updates only after these are acknowledged.
    if (message.kind !== 'update') return;
    this.updates += 1;
    this.send({ ack: 1 });
  }

  /** Asks for scans, paths and ways of robots, by id; ways: 'all' of all. */
  watch(wishes) {
    this.wishes = wishes;
    this.send({ watch: wishes });
  }

  /** Asks for a least duration between two updates [s]. */
  slowTo(gap) {
    if (Math.abs(gap - this.gap) < NOTABLE * Math.max(gap, this.gap)) return;
    this.gap = gap;
    this.send({ gap });
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
