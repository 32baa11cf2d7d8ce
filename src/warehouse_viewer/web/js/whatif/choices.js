// SPDX-License-Identifier: Apache-2.0
// What the fields of the page offer, and the settings that they say.

import { $, make } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { DAYS, layoutOf, robotsOf, ROLES, stationsOf } from './words.js';

export const option = (value, textContent = value) => make('option', { value, textContent });

/** Fills a select with presets and files, keeping what is chosen. */
export function fillLayouts(select, about, chosen = select.value) {
  const presets = Object.entries(about.presets).map(([name, { robots, stations }]) => option(name, `${name}: ${robotsOf(robots)}, ${stationsOf(stations)}`));
  const files = about.layouts.map((name) => option(name, layoutOf(name)));
  select.replaceChildren(group(tr`Ready made`, presets), ...(files.length ? [group(tr`Your own`, files)] : []));
  choose(select, chosen);
}

function group(label, options) {
  return make('optgroup', { label }, ...options);
}

/** Chooses a value; one that is not offered is, so that a person sees what is gone. */
export function choose(select, value) {
  if (value && ![...select.options].some((choice) => choice.value === value)) select.append(option(value));
  if (value) select.value = value;
}

/** What a layout has itself, as the hint of an empty field. */
export function hintCounts(about, layout, fields) {
  const preset = about.presets[layout];
  for (const [field, what] of fields) field.placeholder = !preset ? tr`as drawn` : what === 'robots' ? tr`its ${preset[what]}` : tr`all ${preset[what]}`;
}

export function fillDays(select) {
  select.replaceChildren(...Object.entries(DAYS).map(([value, text]) => option(value, text)));
}

export function fillPolicies(box, about) {
  box.replaceChildren(...Object.entries(about.policies).map(([role, names]) => {
    const usual = about.default_policies[role];
    const select = make('select', { id: `policy-${role}` }, option('', tr`${usual} (usual)`), ...names.filter((name) => name !== usual).map((name) => option(name)));
    return make('label', {}, `${ROLES[role] ?? role} `, select);
  }));
}

/** The policies that are chosen, by role. */
export function policiesOf(about) {
  const chosen = Object.keys(about.policies).map((role) => [role, $(`policy-${role}`).value]);
  return Object.fromEntries(chosen.filter(([, name]) => name));
}

const OF_FILES = ['day', 'demand'];

/** {kind, rate, lines, pieces, file, times} of orders as simulate takes them. */
export function partsOf(orders) {
  const usual = { kind: 'fill', rate: 300, lines: 1.55, pieces: 1.05, file: '', times: 1 };
  const [kind, rate, size] = orders.split(':');
  if (OF_FILES.includes(kind)) {
    const [file, times = '1'] = orders.slice(kind.length + 1).split('*');
    return { ...usual, kind, file, times: Number(times) };
  }
  if (orders.endsWith('.csv')) return { ...usual, kind: 'file', file: orders };
  if (kind === 'mix') {
    const [lines, pieces] = size.split('x').map(Number);
    return { ...usual, kind: 'mix', rate: Number(rate), lines, pieces };
  }
  return { ...usual, kind: orders === 'fill' ? 'fill' : orders };
}

/** Orders as simulate takes them, of what partsOf() returns. */
export function ordersText({ kind, rate, lines, pieces, file, times }) {
  if (kind === 'file') return file;
  if (OF_FILES.includes(kind)) return `${kind}:${file}${times === 1 ? '' : `*${times}`}`;
  return kind === 'mix' ? `mix:${rate}:${lines}x${pieces}` : kind;
}

/** Whether a file holds orders of that kind. */
export function fitsOrders(kind, file) {
  return file.endsWith('.csv') === (kind !== 'demand');
}

/** A name that no scenario has yet. */
export function freeName(stem, taken) {
  if (!taken.includes(stem)) return stem;
  let n = 2;
  while (taken.includes(`${stem} ${n}`)) n += 1;
  return `${stem} ${n}`;
}
