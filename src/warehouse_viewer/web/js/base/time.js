// SPDX-License-Identifier: Apache-2.0
// Times and spans of time in words.

const pad = (n) => String(Math.floor(n)).padStart(2, '0');

/** Seconds since the simulation began, as 1:02:03. */
export function clock(seconds) {
  return `${Math.floor(seconds / 3600)}:${pad(seconds / 60 % 60)}:${pad(seconds % 60)}`;
}

/** A span [s], as '40 s', '12 min' or '1 h 5 min'. */
export function lasting(seconds) {
  const s = Math.max(0, Math.round(seconds));
  if (s < 100) return `${s} s`;
  const minutes = Math.round(s / 60);
  return minutes < 60 ? `${minutes} min` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

/** A span [s] on an axis: '12 min', or '3:45' where it is not a whole number of minutes. */
export function before(seconds) {
  const s = Math.round(seconds);
  if (s < 60) return `${s} s`;
  return s % 60 ? `${Math.floor(s / 60)}:${pad(s % 60)}` : `${s / 60} min`;
}
