// SPDX-License-Identifier: Apache-2.0
// Times of a recording as a person reads and writes them.

const two = (number) => String(number).padStart(2, '0');

/** Seconds as h:mm:ss. */
export function hms(seconds) {
  const whole = Math.max(0, Math.floor(seconds + 1e-6));
  return `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}

/** The time on the wall at that many seconds since 1970, as hh:mm:ss. */
export function wallClock(seconds) {
  const at = new Date(1000 * seconds);
  return [at.getHours(), at.getMinutes(), at.getSeconds()].map(two).join(':');
}

/** Seconds of '10:42' or '10:42:30', after midnight or after a shift's begin; null: it is no such time. */
export function readClock(text) {
  const match = /^(\d{1,4}):([0-5]\d)(?::([0-5]\d))?$/.exec(text);
  return match && 3600 * Number(match[1]) + 60 * Number(match[2]) + Number(match[3] ?? 0);
}
