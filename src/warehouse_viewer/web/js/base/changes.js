// SPDX-License-Identifier: Apache-2.0
// What changes in the work of the warehouse, over the WebSocket /api/v1/changes, which reconnects by
// itself.

import { reloadIfLockedOut } from './api.js';
import { on } from './dom.js';
import { ROOT } from './root.js';

const RETRY = 1000; // [ms]

export class Changes {
  /** handlers: for each of `topics`, and `shift`, what takes its message; `state(live)`, called as soon
   *  as it is open: a list that is read from then on misses no change. */
  constructor(topics, handlers) {
    Object.assign(this, { topics, handlers });
    this.open();
  }

  open() {
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    this.socket = new WebSocket(`${scheme}://${location.host}${ROOT}/api/v1/changes?of=${this.topics}`);
    on(this.socket, 'open', () => this.handlers.state?.(true));
    on(this.socket, 'message', ({ data }) => {
      const message = JSON.parse(data);
      this.handlers[message.type]?.(message);
    });
    on(this.socket, 'close', () => {
      if (this.isOver) return;
      this.handlers.state?.(false);
      reloadIfLockedOut();
      setTimeout(() => this.open(), RETRY);
    });
  }

  close() {
    this.isOver = true;
    this.socket.close();
  }
}
