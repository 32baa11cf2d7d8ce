// SPDX-License-Identifier: Apache-2.0
// What comes of the shift that runs, from now on: as it is, and with changes, side by side.

import { get, post } from '../base/api.js';
import { $, make, on } from '../base/dom.js';
import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';
import { clock } from '../base/time.js';
import { changesOf, refusalOf } from '../replay/changes.js';

const PAUSE = 500; // between two looks for a forecast [ms]
const MOST = 6; // forecasts side by side
const AGAINST = 'against as it is: '; // begins what changes make, in a forecast's text
const ROWS = [
  [tr`Orders done`, ({ done }) => rangeOf(done)],
  [tr`Orders open then`, ({ open }) => rangeOf(open)],
  [tr`Orders late`, ({ late }) => rangeOf(late)],
  [tr`All orders of now done at`, ({ finish }) => endOf(finish)],
  [tr`The changes make`, ({ text }) => differenceOf(text)],
  [tr`Made at, runs`, ({ made_at: at, runs }) => `${clock(at)}, ${number(runs)}`],
];

/** The last of a band, as '414 (370–437)'. */
export function rangeOf({ p10, p50, p90 }) {
  const [low, middle, high] = [p10, p50, p90].map((values) => number(Math.round(values.at(-1))));
  return `${middle} (${low}–${high})`;
}

/** When all orders are done; null: not within. */
export function endOf({ p10, p50, p90 }) {
  if (p50 === null) return tr`not within`;
  return `${clock(p50)} (${clock(p10)}–${p90 === null ? 'later' : clock(p90)})`;
}

/** What a forecast's text says that changes make, a line each. */
export const differenceOf = (text) => (text.split(AGAINST)[1] ?? '').replaceAll(', ', '\n');

export class FromNow {
  constructor() {
    this.columns = [];
    on($('now-form'), 'submit', (event) => {
      event.preventDefault();
      this.lookAhead();
    });
    on($('now-clear'), 'click', () => this.show([]));
  }

  async lookAhead() {
    const changes = changesOf($('now-changes').value);
    $('now-go').disabled = true;
    this.say(tr`looks ahead for about 20 s …`);
    try {
      const asked = await post('/forecasts', { minutes: Number($('now-minutes').value), changes });
      const forecast = await this.answer(asked.forecast_id);
      this.say('');
      this.show([...this.columns, forecast].slice(-MOST));
    } catch (error) {
      this.say(refusalOf(error.message, $('now-changes').value), 'refused');
    } finally {
      $('now-go').disabled = false;
    }
  }

  /** A forecast once it is done; throws an Error where none came of it. */
  async answer(id) {
    for (;;) {
      const forecast = await get(`/forecasts/${id}`);
      if (forecast.state === 'REPLACED') throw new Error(tr`A newer forecast was asked for meanwhile; ask again.`);
      if (forecast.state === 'DONE' && !forecast.runs) throw new Error(forecast.text);
      if (forecast.state === 'DONE') return forecast;
      await new Promise((done) => { setTimeout(done, PAUSE); });
    }
  }

  say(text, kind = '') {
    $('now-told').textContent = text;
    $('now-told').className = kind ? 'answer' : 'dim';
    $('now-told').dataset.kind = kind;
  }

  show(columns) {
    this.columns = columns;
    $('now-box').hidden = $('now-clear').hidden = !columns.length;
    const head = columns.map(({ changes, minutes }) => make('th', { scope: 'col', textContent: tr`${changes.map((line) => line.replace(/^\+0 /, '')).join(', ') || tr`as it is`}; ${number(minutes)} min` }));
    const rows = ROWS.map(([title, cell]) => make('tr', {},
      make('th', { scope: 'row', textContent: title }), ...columns.map((column) => make('td', { textContent: cell(column) }))));
    $('now-table').replaceChildren(make('thead', {}, make('tr', {}, make('td'), ...head)), make('tbody', {}, ...rows));
  }
}
