// SPDX-License-Identifier: Apache-2.0
// Which robots and stations have a label.

import { NEEDS_HELP } from '../base/words.js';

export const LABEL_HEIGHT = 0.42; // above the floor [m]
const LARGE = 24; // [px] a metre: robots seen so large have a number
const MOST = 60; // of numbers, and of names
const READABLE = 4; // [px] a metre: a station that is seen so large has its sign, if there is room
const LETTER = 6.2, FRAME = 18, LINE = 14, HIGH = 22; // of a sign: a letter, what is around, before its note, height [px]
const TOUCH = 4; // largest overlap of two signs [px]

/** Indices of robots in sight of a View: {names, numbers}. Names have those of the set `wanted` and
 *  blocked robots; numbers the nearest of those that are seen large. */
export function labelled({ shown, activity }, view, always) {
  const names = [], numbers = [], scales = new Map();
  for (let i = 0; i < activity.length; ++i) { // of ten thousand, before each picture
    const scale = view.scaleAt(shown[3 * i], shown[3 * i + 1], LABEL_HEIGHT, 0.5);
    const matters = always.has(i) || activity[i] === NEEDS_HELP;
    if (scale < (matters ? Number.MIN_VALUE : LARGE)) continue;
    scales.set(i, scale);
    (matters ? names : numbers).push(i);
  }
  const nearestFirst = (a, b) => scales.get(b) - scales.get(a) || a - b;
  return {
    names: names.sort((a, b) => always.has(b) - always.has(a) || nearestFirst(a, b)).slice(0, MOST),
    numbers: numbers.sort(nearestFirst).slice(0, MOST),
  };
}

/** Returns the signs {text, kind, note, pixel [x, y]} that lie over none before them; what a person has to
 *  know goes first. */
export function apart(signs) {
  const out = [];
  for (const sign of [...signs].sort((a, b) => matters(b) - matters(a))) if (!out.some((other) => overlap(sign, other))) out.push(sign);
  return out;
}

const matters = ({ kind }) => Number(kind !== 'sign' && kind !== 'sign small');

function overlap(a, b) {
  const [dx, dy] = [0, 1].map((i) => Math.abs(a.pixel[i] - b.pixel[i]));
  return dy < HIGH && dx < (widthOf(a) + widthOf(b)) / 2 - TOUCH;
}

/** A count that comes or goes changes nothing. */
function widthOf({ text, note }) {
  return FRAME + LETTER * text.length + LINE + LETTER * Math.max(1, note.length);
}

/** The nearest of the stations in sight of a View that are seen large enough. */
export function namedStations(stations, view) {
  return stations.map((station) => ({ station, scale: view.scaleAt(station.x, station.y, 0, 0.5) }))
    .filter(({ scale }) => scale >= READABLE)
    .sort((a, b) => b.scale - a.scale).slice(0, MOST).map(({ station }) => station);
}
