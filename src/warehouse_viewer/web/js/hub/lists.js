// SPDX-License-Identifier: Apache-2.0
// The lists below the warehouses: recordings, and the journal.

import { $, make } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { durationOf } from './card.js';
import * as server from './server.js';

const PERIOD = 3000; // between two looks [ms]
const SHOWN = 100; // entries of the journal

export class Lists {
  constructor() {
    this.looked = -Infinity;
    this.entries = [];
    this.shown = '';
  }

  /** Fetches what is new, if the last look is long ago. */
  async look() {
    if (performance.now() - this.looked < PERIOD) return;
    this.looked = performance.now();
    const last = this.entries[0]?.id ?? 0;
    const [recordings, news] = await Promise.all([server.recordings(), server.journal(last)]).catch(() => [null, []]);
    if (recordings) this.showRecordings(recordings);
    if (news.length || !last) this.showJournal(news);
    $('docs-missing').hidden = !document.querySelector('[data-needs="/docs/"]').hidden;
  }

  showRecordings(rows) {
    const text = JSON.stringify(rows);
    if (text === this.shown) return;
    this.shown = text;
    $('recording-list').replaceChildren(...rows.map(recordingOf));
  }

  showJournal(news) {
    this.entries = [...news.reverse(), ...this.entries].slice(0, SHOWN);
    $('journal-list').replaceChildren(...this.entries.map(entryOf));
    if (!this.entries.length) $('journal-list').append(make('li', { className: 'dim', textContent: tr`Nothing was changed yet.` }));
  }
}

function recordingOf({ name, kind, url, seconds, time, reason }) {
  const title = { example: tr`A shift at work (an example)`, simulation: name }[kind] ?? name;
  const from = kind === 'example' ? '' : `, ${new Date(1000 * time).toLocaleString()}`;
  const about = url ? tr`${durationOf(seconds)} of simulated time${from}` : '';
  return make('li', {}, url ? make('a', { href: url, textContent: title }) : title,
    make('span', { className: 'dim', textContent: [about, reason].filter(Boolean).join('; ') }));
}

function entryOf({ wall, kind, who, action, simulation, arguments: asked, outcome, done }) {
  const where = simulation && simulation !== '-' ? ` (${simulation})` : '';
  return make('li', {}, make('time', { className: 'dim', dateTime: wall, textContent: wall.slice(0, 19).replace('T', ' ') }),
    make('b', { textContent: `${kind === 'assistant' ? tr`assistant ` : ''}${who}` }),
    make('span', { textContent: `${action}${where} ${asked}` }),
    make('span', { className: done ? 'dim' : 'refused', textContent: outcome }));
}
