// SPDX-License-Identifier: Apache-2.0
// The states of stations as they change, and whether the server is reached. A lost network closes
// no socket: it is noticed by a timeout.

import { Changes } from '../base/changes.js';
import { at } from '../base/root.js';

const QUIET = 4000; // without a word the server is asked [ms]
const PATIENCE = 3500; // for its answer [ms]
const LOOK = 1000; // [ms]

export class News {
  /** handlers: take(stations), link(state): 'live', 'idle' where no shift runs, 'away'. */
  constructor(handlers) {
    Object.assign(this, { handlers, heard: 0, state: '', isAsking: false });
    this.subscribe();
    setInterval(() => this.look(), LOOK);
    addEventListener('online', () => this.ask());
  }

  subscribe() {
    this.changes?.close();
    this.changes = new Changes(['stations'], {
      state: (live) => { if (!live) this.ask(); },
      shift: ({ runs }) => this.hear(runs ? 'live' : 'idle'),
      stations: ({ stations }) => {
        this.hear('live');
        this.handlers.take(stations);
      },
    });
  }

  hear(state) {
    this.heard = performance.now();
    if (this.state === 'away') this.subscribe(); // the old socket may never hear of the gap
    if (this.state !== state) this.handlers.link(state);
    this.state = state;
  }

  look() {
    if (performance.now() - this.heard > QUIET) this.ask();
  }

  async ask() {
    if (this.isAsking) return;
    this.isAsking = true;
    try {
      const answer = await fetch(at('/api/v1/stations'), { signal: AbortSignal.timeout(PATIENCE) });
      const body = await answer.json();
      this.hear(answer.ok ? 'live' : 'idle');
      if (answer.ok) this.handlers.take(body.stations);
    } catch {
      if (this.state !== 'away') this.handlers.link('away');
      this.state = 'away';
    }
    this.isAsking = false;
  }
}
