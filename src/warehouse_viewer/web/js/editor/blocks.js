// SPDX-License-Identifier: Apache-2.0
// A block of cells with its stations: copied, mirrored, turned, put in, repeated.

import { isLetter, MIRRORED, NOTHING, TURNED } from './characters.js';
import { cellsOf } from './shapes.js';
import { stationAt } from './text.js';

/** A block {width, height, rows, stations} of the cells of a rectangle; lanes that leave it stay
 *  behind. */
export function copied(drawing, rect) {
  const { left, bottom, right, top } = rect, rows = [];
  for (let row = bottom; row < top; row++) {
    const line = [];
    for (let column = left; column < right; column++) {
      const char = drawing.get(column, row);
      line.push(isLetter(char) ? '.' : char);
    }
    rows.push(line);
  }
  const isIn = ([column, row]) => column >= left && column < right && row >= bottom && row < top;
  const moved = ([column, row]) => [column - left, row - bottom];
  const lane = (cells) => (cells.every(isIn) ? cells.map(moved) : []);
  const within = (cuts) => cuts.map(lane).filter((cut) => cut.length);
  const stations = drawing.stations.filter((s) => isIn(s.service)).map((s) => ({
    ...s, service: moved(s.service), queue: lane(s.queue), exit: lane(s.exit), short_cuts: lane(s.queue).length ? within(s.short_cuts) : [],
  }));
  return { width: right - left, height: top - bottom, rows, stations };
}

/** A block in a mirror that swaps left and right ('x') or top and bottom ('y'). */
export function mirrored(block, axis) {
  const { width, height } = block;
  const moved = ([column, row]) => (axis === 'x' ? [width - 1 - column, row] : [column, height - 1 - row]);
  return mapped(block, width, height, moved, MIRRORED[axis]);
}

/** A block, turned to the left by a quarter. */
export function turned(block) {
  return mapped(block, block.height, block.width, ([column, row]) => [block.height - 1 - row, column], TURNED);
}

function mapped(block, width, height, moved, arrows) {
  const rows = Array.from({ length: height }, () => Array(width).fill(NOTHING));
  block.rows.forEach((line, row) => line.forEach((char, column) => {
    const [x, y] = moved([column, row]);
    rows[y][x] = arrows[char] ?? char;
  }));
  const stations = block.stations.map((s) => stationAt(s, moved));
  return { width, height, rows, stations };
}

/** Puts a block's lower left cell at [column, row]. Where it has no floor, what is there stays.
 *  Stations keep key and name if these are free. */
export function putIn(drawing, block, [column, row]) {
  const moved = ([x, y]) => [x + column, y + row];
  block.rows.forEach((line, y) => line.forEach((char, x) => {
    if (char !== NOTHING) drawing.set(x + column, y + row, char);
  }));
  for (const { key, name, service, queue, exit, short_cuts: cuts, ...like } of block.stations) {
    const station = drawing.addStation(moved(service), like);
    if (!station) continue;
    rename(drawing, station, key, name);
    drawing.setLane(station, 'queue', queue.map(moved));
    station.short_cuts = cuts.map((cut) => cut.map(moved));
    drawing.setLane(station, 'exit', exit.map(moved));
  }
}

/** Gives a station the key and the name that it had before, if no other has them. */
function rename(drawing, station, key, name) {
  const others = drawing.stations.filter((s) => s !== station);
  if (!others.some((s) => s.name === name)) station.name = name;
  if (isLetter(key) && isLetter(station.key) && !others.some((s) => s.key === key)) {
    station.key = key;
    drawing.cells[drawing.index(...station.service)] = key.charCodeAt(0);
  }
}

export function clear(drawing, rect) {
  for (const [column, row] of cellsOf(rect)) drawing.set(column, row, NOTHING);
}

/** Puts a block in the place of a rectangle; returns the new rectangle, with the same lower left. */
export function replaced(drawing, rect, block) {
  clear(drawing, rect);
  const { left, bottom } = rect;
  putIn(drawing, block, [left, bottom]);
  return { left, bottom, right: left + block.width, top: bottom + block.height };
}

/** Repeats a rectangle to the right and upwards: that often altogether, with a gap [cells]. Returns
 *  the rectangle of all. */
export function repeated(drawing, rect, columns, rows, gap = 0) {
  const block = copied(drawing, rect), { left, bottom } = rect;
  const across = block.width + gap, up = block.height + gap;
  for (let j = 0; j < rows; j++) {
    for (let i = 0; i < columns; i++) if (i || j) putIn(drawing, block, [left + i * across, bottom + j * up]);
  }
  return { left, bottom, right: left + columns * across - gap, top: bottom + rows * up - gap };
}
