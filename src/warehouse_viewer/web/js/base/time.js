// SPDX-License-Identifier: Apache-2.0
// Times and spans of time in words: the same on every page.

import { tr } from '../language/texts.js';

const pad = (n) => String(n).padStart(2, '0');

/** Simulated time [s] since the beginning, as 0:02:05; `hasTenths`: as 0:02:05.3. */
export function clock(seconds, hasTenths = false) {
  const tenths = hasTenths ? Math.round(10 * Math.max(0, seconds)) : 10 * Math.floor(Math.max(0, seconds) + 1e-6);
  const whole = Math.floor(tenths / 10);
  const text = `${Math.floor(whole / 3600)}:${pad(Math.floor(whole / 60) % 60)}:${pad(whole % 60)}`;
  return hasTenths ? `${text}.${tenths % 10}` : text;
}

/** The time on the wall at that many seconds since 1970, as hh:mm:ss. */
export function wallClock(seconds) {
  const at = new Date(1000 * seconds);
  return [at.getHours(), at.getMinutes(), at.getSeconds()].map(pad).join(':');
}

/** Seconds of '10:42' or '10:42:30', after midnight or after a shift's begin; null: it is no such time. */
export function readClock(text) {
  const match = /^(\d{1,4}):([0-5]\d)(?::([0-5]\d))?$/.exec(text);
  return match && 3600 * Number(match[1]) + 60 * Number(match[2]) + Number(match[3] ?? 0);
}

/** A span [s], as '40 s', '12 min' or '1 h 5 min'. */
export function lasting(seconds) {
  const s = Math.max(0, Math.round(seconds));
  if (s < 100) return `${s} s`;
  const minutes = Math.round(s / 60);
  return minutes < 60 ? tr`${minutes} min` : tr`${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

/** A span [s] on an axis: '12 min', or '3:45' where it is not a whole number of minutes. */
export function before(seconds) {
  const s = Math.round(seconds);
  if (s < 60) return `${s} s`;
  return s % 60 ? `${Math.floor(s / 60)}:${pad(s % 60)}` : tr`${s / 60} min`;
}
