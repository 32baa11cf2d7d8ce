// SPDX-License-Identifier: Apache-2.0
// Which robots and stations have a label.

import { NEEDS_HELP } from './words.js';

export const LABEL_HEIGHT = 0.42; // above the floor [m]
const LARGE = 24; // [px] a metre: robots seen so large have a number
const MOST = 60; // of numbers, and of names
const READABLE = 10; // [px] a metre: a station that is seen so large has its name

/** Indices of robots in sight of a View: {names, numbers}. Names have those of the set `wanted` and
 *  blocked robots; numbers the nearest of those that are seen large. */
export function labelled({ shown, activity }, view, wanted) {
  const names = [], numbers = [], scales = new Map();
  for (let i = 0; i < activity.length; ++i) { // of ten thousand, before each picture
    const scale = view.scaleAt(shown[3 * i], shown[3 * i + 1], LABEL_HEIGHT, 0.5);
    const matters = wanted.has(i) || activity[i] === NEEDS_HELP;
    if (scale < (matters ? Number.MIN_VALUE : LARGE)) continue;
    scales.set(i, scale);
    (matters ? names : numbers).push(i);
  }
  const nearestFirst = (a, b) => scales.get(b) - scales.get(a) || a - b;
  return {
    names: names.sort((a, b) => wanted.has(b) - wanted.has(a) || nearestFirst(a, b)).slice(0, MOST),
    numbers: numbers.sort(nearestFirst).slice(0, MOST),
  };
}

/** The nearest of the stations in sight of a View that are seen large enough. */
export function namedStations(stations, view) {
  return stations.map((station) => ({ station, scale: view.scaleAt(station.x, station.y, 0, 0.5) }))
    .filter(({ scale }) => scale >= READABLE)
    .sort((a, b) => b.scale - a.scale).slice(0, MOST).map(({ station }) => station);
}
