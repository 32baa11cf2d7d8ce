// SPDX-License-Identifier: Apache-2.0
// The WebSocket, which comes back by itself.

import { on } from './dom.js';
import { decode } from './protocol.js';

const RETRY = [500, 1000, 2000, 4000]; // [ms]

export class Connection {
  /** handlers: {update, scan, ways, scene, status, events, paths, fleet} for what comes, state(live). */
  constructor(handlers) {
    this.handlers = handlers;
    this.failures = 0;
    this.bytes = this.updates = 0; // of updates, since the start
    this.wishes = null;
    this.open();
  }

  open() {
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    this.socket = new WebSocket(`${scheme}://${location.host}/live`);
    this.socket.binaryType = 'arraybuffer';
    on(this.socket, 'open', () => this.greet());
    on(this.socket, 'message', (message) => this.take(message.data));
    on(this.socket, 'close', () => this.again());
  }

  greet() {
    this.failures = 0;
    this.handlers.state(true);
    if (this.wishes) this.send({ watch: this.wishes });
  }

  again() {
    this.handlers.state(false);
    setTimeout(() => this.open(), RETRY[Math.min(this.failures++, RETRY.length - 1)]);
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
    // The next ones come only to who has seen these.
    if (message.kind !== 'update') return;
    this.updates += 1;
    this.send({ ack: 1 });
  }

  /** Asks for scans, paths and ways of robots, by id; ways: 'all' of all. */
  watch(wishes) {
    this.wishes = wishes;
    this.send({ watch: wishes });
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
