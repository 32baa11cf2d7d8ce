// SPDX-License-Identifier: Apache-2.0
// Scenarios and figures in words.

import { number } from '../base/numbers.js';
import { linesOf } from './events.js';

export const DAYS = {
  '': 'ideal, meeting no traffic: quickest',
  ideal: 'simulated, on an ideal day',
  typical: 'simulated, on a typical day',
  bad_day: 'simulated, on a bad day',
};
const DAYS_SHORT = { '': 'ideal robots', ideal: 'simulated, ideal day', typical: 'simulated, typical day', bad_day: 'simulated, bad day' };
export const ROLES = {
  orders: 'Which order a station takes on',
  units: 'Which unit is brought',
  storage: 'Where a unit is put afterwards',
  bins: 'Where new stock goes',
  replenishment: 'When stock is refilled',
  robots: 'Which robot does a transport',
  idle: 'Where idle robots wait',
  charging: 'When robots charge',
};
export const BADGES = {
  none: ['resting', 'not run yet'],
  part: ['resting', 'not all runs'],
  runs: ['moving', 'runs'],
  done: ['working', 'done'],
  cancelled: ['resting', 'cancelled'],
  cut: ['waiting', 'cut off'],
  failed: ['needs-help', 'failed'],
  wrong: ['needs-help', 'can’t be read'],
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
  return minutes < 60 ? `${minutes} min` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

export function plural(count, noun) {
  return `${number(count)} ${noun}${count === 1 ? '' : 's'}`;
}

export const layoutOf = (layout) => layout.replace(/\.layout\.yaml$/, '');

export function ordersOf(orders) {
  const [kind, rate, size] = orders.split(':');
  if (kind === 'fill') return 'orders never run out';
  if (kind === 'poisson') return rate ? `${number(Number(rate))} orders an hour` : 'orders by chance';
  if (kind === 'mix') return `${number(Number(rate))} orders an hour${size === '1.55x1.05' ? '' : ` of ${size.replace('x', ' lines × ')} pieces`}`;
  if (kind === 'day' || kind === 'demand') {
    const [file, times] = rate.split('*');
    const more = times ? `, × ${times}` : '';
    return kind === 'day' ? `the day of ${file}${more}` : `days as ${file.replace(/\.demand\.yaml$/, '')}${more}`;
  }
  return `orders of ${orders}`;
}

const eventsInWords = (events = []) => (events.length ? plural(events.length, 'event') : 'none');

export const dayOf = ({ physics, realism }) => (physics ? realism || 'ideal' : '');

/** What a scenario is, in a line. */
export function describe(settings, site) {
  const policies = Object.entries(settings.policies).map(([role, name]) => `${role}: ${name}`);
  return [layoutOf(settings.layout), plural(site.robots, 'robot'), plural(site.stations, 'station'), ordersOf(settings.orders),
    `${settings.minutes} min × ${settings.seeds}`, DAYS_SHORT[dayOf(settings)], ...policies,
    ...(settings.events?.length ? [eventsInWords(settings.events)] : [])].join(' · ');
}

/** [what, a text for each scenario] of what is not the same in all. */
export function differences(scenarios, defaults) {
  const texts = {
    Layout: ({ settings }) => layoutOf(settings.layout),
    Robots: ({ site }) => number(site.robots),
    'Picking stations': ({ site }) => number(site.stations),
    Orders: ({ settings }) => ordersOf(settings.orders),
    'Minutes of work': ({ settings }) => number(settings.minutes),
    Repetitions: ({ settings }) => number(settings.seeds),
    'Robots are': ({ settings }) => DAYS_SHORT[dayOf(settings)],
    Events: ({ settings }) => linesOf(settings.events).join('; ') || 'none',
  };
  for (const [role, name] of Object.entries(ROLES)) texts[name] = ({ settings }) => settings.policies[role] ?? defaults[role];
  return Object.entries(texts).map(([what, textOf]) => [what, scenarios.map(textOf)])
    .filter(([, row]) => new Set(row).size > 1);
}
