// SPDX-License-Identifier: Apache-2.0
// Scenarios and figures in words.

import { number } from '../language/numbers.js';
import { plural, tr } from '../language/texts.js';
import { linesOf } from './events.js';

export const DAYS = {
  '': tr`ideal, meeting no traffic: quickest`,
  ideal: tr`simulated, on an ideal day`,
  typical: tr`simulated, on a typical day`,
  bad_day: tr`simulated, on a bad day`,
};
const DAYS_SHORT = { '': tr`ideal robots`, ideal: tr`simulated, ideal day`, typical: tr`simulated, typical day`, bad_day: tr`simulated, bad day` };
export const ROLES = {
  orders: tr`Which order a station takes on`,
  units: tr`Which unit is brought`,
  storage: tr`Where a unit is put afterwards`,
  bins: tr`Where new stock goes`,
  replenishment: tr`When stock is refilled`,
  robots: tr`Which robot does a transport`,
  idle: tr`Where idle robots wait`,
  charging: tr`When robots charge`,
};
export const BADGES = {
  none: ['resting', tr`not run yet`],
  part: ['resting', tr`not all runs`],
  runs: ['moving', tr`runs`],
  done: ['working', tr`done`],
  cancelled: ['resting', tr`cancelled`],
  cut: ['waiting', tr`cut off`],
  failed: ['needs-help', tr`failed`],
  wrong: ['needs-help', tr`can’t be read`],
};

export { number };

/** What limits a scenario, and when: 'the picking stations, 3:20 to 5:20'. */
export const limitOf = ({ what, when }) => (when ? `${what}, ${when}` : what);

/** A mean with half its interval: '1,405 ± 12'. */
export function interval({ mean, half }, digits = 0) {
  return half === null ? number(mean, digits) : `${number(mean, digits)} ± ${number(half, digits)}`;
}

/** Seconds as a person says them. */
export function duration(seconds) {
  if (seconds < 50) return `${Math.max(5 * Math.ceil(seconds / 5), 5)} s`;
  const minutes = Math.ceil(seconds / 60);
  return minutes < 60 ? tr`${minutes} min` : tr`${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

export const robotsOf = (count) => plural(count, '{n} robot', '{n} robots');
export const stationsOf = (count) => plural(count, '{n} station', '{n} stations');
export const runsOf = (count) => plural(count, '{n} run', '{n} runs');

export const layoutOf = (layout) => layout.replace(/\.layout\.yaml$/, '');

export function ordersOf(orders) {
  const [kind, rate, size] = orders.split(':');
  if (kind === 'fill') return tr`orders never run out`;
  if (kind === 'poisson') return rate ? tr`${number(Number(rate))} orders an hour` : tr`orders by chance`;
  if (kind === 'mix') return tr`${number(Number(rate))} orders an hour${size === '1.55x1.05' ? '' : tr` of ${size.replace('x', tr` lines × `)} pieces`}`;
  if (kind === 'day' || kind === 'demand') {
    const [file, times] = rate.split('*');
    const more = times ? tr`, × ${times}` : '';
    return kind === 'day' ? tr`the day of ${file}${more}` : tr`days as ${file.replace(/\.demand\.yaml$/, '')}${more}`;
  }
  return tr`orders of ${orders}`;
}

const eventsInWords = (events = []) => (events.length ? plural(events.length, '{n} event', '{n} events') : tr`none`);

export const dayOf = ({ physics, realism }) => (physics ? realism || 'ideal' : '');

/** What a scenario is, in a line. */
export function describe(settings, site) {
  const policies = Object.entries(settings.policies).map(([role, name]) => `${role}: ${name}`);
  return [layoutOf(settings.layout), robotsOf(site.robots), stationsOf(site.stations), ordersOf(settings.orders),
    tr`${settings.minutes} min × ${settings.seeds}`, DAYS_SHORT[dayOf(settings)], ...policies,
    ...(settings.events?.length ? [eventsInWords(settings.events)] : [])].join(' · ');
}

/** [what, a text for each scenario] of what is not the same in all. */
export function differences(scenarios, defaults) {
  const texts = {
    [tr`Layout`]: ({ settings }) => layoutOf(settings.layout),
    [tr`Robots`]: ({ site }) => number(site.robots),
    [tr`Picking stations`]: ({ site }) => number(site.stations),
    [tr`Orders`]: ({ settings }) => ordersOf(settings.orders),
    [tr`Minutes of work`]: ({ settings }) => number(settings.minutes),
    [tr`Repetitions`]: ({ settings }) => number(settings.seeds),
    [tr`Robots are`]: ({ settings }) => DAYS_SHORT[dayOf(settings)],
    [tr`Events`]: ({ settings }) => linesOf(settings.events).join('; ') || tr`none`,
  };
  for (const [role, name] of Object.entries(ROLES)) texts[name] = ({ settings }) => settings.policies[role] ?? defaults[role];
  return Object.entries(texts).map(([what, textOf]) => [what, scenarios.map(textOf)])
    .filter(([, row]) => new Set(row).size > 1);
}
