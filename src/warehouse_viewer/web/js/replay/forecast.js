// SPDX-License-Identifier: Apache-2.0
// What would come of a recorded shift from the moment of the time line on.

import { $, make, on } from '../base/dom.js';
import { ask } from '../base/request.js';
import { clock } from '../base/time.js';
import { changesOf, refusalOf } from './changes.js';
import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';

const LOOK = 500; // between two looks for the result [ms]
const ROWS = 6;

const whole = (value) => number(Math.round(value));
const cell = ({ p10, p50, p90 }, i) => tr`${whole(p50[i])} (${whole(p10[i])} to ${whole(p90[i])})`;

/** [{at, done, open, late}] of a forecast at ROWS times, each as text. */
export function rowsOf({ time, done, open, late }, rows = ROWS) {
  const shown = Array.from({ length: rows }, (_, row) => Math.round((row + 1) * time.length / rows) - 1);
  return [...new Set(shown)].filter((i) => i >= 0).map((i) => ({
    at: clock(time[i]), done: cell(done, i), open: cell(open, i), late: cell(late, i) }));
}

export class ForecastFromHere {
  /** `moment()` returns the time that is shown [s]. */
  constructor(moment) {
    Object.assign(this, { moment, asked: 0 });
    on($('replay-forecast'), 'click', () => this.open());
    on($('ahead-close'), 'click', () => $('ahead').close());
    on($('ahead'), 'close', () => { this.asked++; });
    on($('ahead-form'), 'submit', (event) => {
      event.preventDefault();
      this.make();
    });
  }

  open() {
    this.at = this.moment();
    $('ahead-title').textContent = tr`Forecast from ${clock(this.at)}`;
    this.say('');
    $('ahead').showModal();
    this.make();
  }

  /** A later wish counts. */
  async make() {
    const turn = ++this.asked, change = $('ahead-change').value;
    this.say(tr`looks ahead for about 20 s …`);
    try {
      const wish = { at: this.at, minutes: Number($('ahead-minutes').value), changes: changesOf(change) };
      let forecast = await ask('POST', '/api/v1/forecasts', wish);
      while (forecast.state === 'RUNNING' && turn === this.asked) {
        await new Promise((resolve) => { setTimeout(resolve, LOOK); });
        forecast = await ask('GET', `/api/v1/forecasts/${forecast.forecast_id}`);
      }
      if (turn === this.asked) this.show(forecast);
    } catch (error) {
      if (turn === this.asked) this.say(refusalOf(error.message, change));
    }
  }

  show({ state, text, runs, ...bands }) {
    this.say(state === 'REPLACED' ? tr`another page asked for a newer forecast` : `${text[0].toUpperCase()}${text.slice(1)}.`);
    if (!runs) return;
    const rows = rowsOf(bands).map((row) => make('tr', {}, ...Object.values(row).map((textContent) => make('td', { textContent }))));
    $('ahead-table').tBodies[0].replaceChildren(...rows);
    $('ahead-table').hidden = false;
  }

  say(text) {
    $('ahead-text').textContent = text;
    $('ahead-table').hidden = true;
  }
}
