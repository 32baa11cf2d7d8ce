// SPDX-License-Identifier: Apache-2.0
// How many robots do what at a glance, what work that is, and which of them wait.

import { $, keepRows, make, setText } from '../base/dom.js';
import { number } from '../language/numbers.js';
import { ROOT } from '../base/root.js';
import { tr } from '../language/texts.js';
import { lasting } from '../base/time.js';
import { ACTIVITY, ACTIVITY_CLASS, ACTIVITY_NAMES, counted, countedWork } from '../base/words.js';

const MOST_WAITS = 6;

/** [{text, look, count}] of the activities that some robots have, what needs a person first. */
export function sharesOf(activities) {
  return ACTIVITY_NAMES.map((name, i) => (
    { text: ACTIVITY[i], look: ACTIVITY_CLASS[i], count: activities[name.toLowerCase()] })).filter(({ count }) => count).reverse();
}

export class RobotShares {
  /** `fleet` from the server; null without a coordinator. */
  show(fleet) {
    $('fleet').textContent = fleet ? '' : tr`no coordinator runs`;
    if (!fleet) return;
    const shares = sharesOf(fleet.activities ?? {});
    $('robots').replaceChildren(...shares.map(({ text, look, count }) => {
      const bar = make('div', { className: look, title: `${count} ${text}` });
      bar.style.flex = count;
      return bar;
    }));
    $('robots-legend').replaceChildren(...shares.map(({ text, look, count }) => (
      make('li', {}, make('i', { className: `key ${look}` }), make('b', { textContent: count }), ` ${text}`))));
    const { work, robots: { manual, out_of_service: out }, transports } = fleet;
    $('work').textContent = [countedWork(work), counted({ manual, out_of_service: out }, '')].filter(Boolean).join(', ');
    $('fleet').textContent = tr`${number(transports.under_way)} transports under way, ${number(transports.open)} waiting for a robot`;
    this.showWaits(fleet);
  }

  showWaits({ waiting, time }) {
    const more = waiting.length - MOST_WAITS;
    const longest = [...waiting].sort((a, b) => a.since - b.since).slice(0, MOST_WAITS);
    const rows = [...longest, ...more > 0 ? [{ more }] : []];
    keepRows($('waiting'), rows, { keyOf: ({ robot }) => robot ?? 'more', create: waitRow, show: (row, wait) => {
      const { since, text: why } = wait;
      setText(row.lastChild, wait.more ? tr`and ${wait.more} more` : tr` waits ${lasting(time - since)} ${why}`);
    } });
  }
}

/** A robot's link and what it waits for, or how many more do. */
function waitRow({ robot, more }) {
  const text = make('span');
  return more ? make('li', { className: 'dim' }, text) : make('li', {}, make('a', { href: `${ROOT}/#kiva${robot}`, textContent: `kiva${robot}` }), text);
}
