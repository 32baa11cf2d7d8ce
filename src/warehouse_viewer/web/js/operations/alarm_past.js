// SPDX-License-Identifier: Apache-2.0
// The alarms that have ended: cause, duration, and who did what.

import { get } from '../base/api.js';
import { $, make } from '../base/dom.js';
import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';
import { clock, lasting } from '../base/time.js';

const SHOWN = 100;

/** Reads and shows them. */
export async function showPast() {
  const { total, alarms, repairs, mean_time_to_repair: mean } = await get('/alarms/history');
  const rows = alarms.slice(0, SHOWN).map(({ text, since, duration, seen_by: by, actions }) => make('li', {},
    make('span', { className: 'dim', textContent: `${clock(since)}, ${lasting(duration)}` }),
    make('span', { textContent: text }),
    make('span', { className: 'dim', textContent: didOf(by, actions) })));
  $('alarm-past-list').replaceChildren(...rows);
  const ended = total ? tr`${number(total)} ended` : tr`None has ended yet`;
  $('alarm-past-sum').textContent = repairs ? tr`${ended}; mean time to repair ${lasting(mean)} (${number(repairs)} repaired)` : ended;
}

/** Who saw an alarm, and who did what about it. */
export function didOf(by, actions) {
  const done = actions.map(({ what, by: who, time }) => `${who || tr`no name`}: ${what} (${clock(time)})`);
  return [by && tr`seen by ${by}`, ...done].filter(Boolean).join('; ') || tr`ended by itself`;
}
