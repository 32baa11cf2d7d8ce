// SPDX-License-Identifier: Apache-2.0
// The batteries of the robots, the emptiest first; read while the section is open.

import { get } from '../base/api.js';
import { $, keepRows, make, on, setText } from '../base/dom.js';
import { number, percent } from '../language/numbers.js';
import { ROOT } from '../base/root.js';
import { tr } from '../language/texts.js';
import { ACTIVITY, ACTIVITY_NAMES } from '../base/words.js';

const EVERY = 5000; // [ms]
const ROWS = 1000; // of an answer
const SHOWN = 60;
const LOW = 0.2, FULL = 0.999;

/** Shows the section's content for as long as it is open. */
export function watchBatteries() {
  let timer;
  const show = async () => {
    clearTimeout(timer);
    if (!$('batteries').open) return;
    if (!document.hidden) await read().then(draw, (error) => { $('battery-sum').textContent = error.message; });
    timer = setTimeout(show, EVERY);
  };
  on($('batteries'), 'toggle', show);
  show();
}

async function read() {
  const all = [];
  for (let total = 1; all.length < total;) {
    const answer = await get(`/robots?limit=${ROWS}&offset=${all.length}`);
    if (!answer.robots.length) break;
    total = answer.total;
    all.push(...answer.robots);
  }
  return all;
}

function draw(robots) {
  const sorted = robots.toSorted((a, b) => a.charge - b.charge || a.id - b.id);
  $('battery-sum').textContent = summary(sorted.map(({ charge }) => charge));
  const used = sorted.filter(({ charge }) => charge < FULL).slice(0, SHOWN);
  keepRows($('battery-list'), used, { keyOf: ({ id }) => id, create: newRow, show: showRow });
}

/** What the charges 0 … 1, the least first, come to. */
export function summary(charges) {
  if (!charges.length) return tr`There is no robot.`;
  if (charges[0] >= FULL) return tr`All are full. Without realism:=typical, or another with energy, none is ever used.`;
  const mean = charges.reduce((sum, charge) => sum + charge, 0) / charges.length;
  const low = charges.filter((charge) => charge < LOW).length, rest = charges.length - SHOWN;
  return [tr`mean ${percent(mean)}`, tr`least ${percent(charges[0])}`, tr`${number(low)} below ${percent(LOW)}`, rest > 0 && tr`the emptiest ${SHOWN} of ${number(charges.length)}`].filter(Boolean).join(', ');
}

function newRow({ name }) {
  return make('li', {}, make('a', { href: `${ROOT}/#${name}`, textContent: name }), make('meter', { min: 0, max: 1, low: LOW, optimum: 1 }),
    make('span', { className: 'number' }), make('span', { className: 'dim' }));
}

function showRow(row, { name, charge, activity, failures }) {
  const [, meter, text, does] = row.children;
  Object.assign(meter, { value: charge, ariaLabel: `${name}: ${percent(charge)}` });
  setText(text, percent(charge));
  setText(does, failures.join(', ') || ACTIVITY[ACTIVITY_NAMES.indexOf(activity)]);
}
