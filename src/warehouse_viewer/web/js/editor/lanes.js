// SPDX-License-Identifier: Apache-2.0
// The lane of a station, drawn cell by cell: the queue towards its service cell, the exit away.

import { FLOOR, isStreet } from './characters.js';
import { besides, same } from './drawing.js';
import { lineCells } from './shapes.js';

/** The path that a pointer has drawn up to a cell; going back takes cells back. */
export function extended(path, cell) {
  let out = path.length ? path : [cell];
  for (const next of lineCells(out.at(-1), cell).slice(1)) {
    const at = out.findIndex((c) => same(c, next));
    out = at >= 0 ? out.slice(0, at + 1) : [...out, next];
  }
  return out;
}

/** The cells of a queue or an exit in driving order from a path that was drawn either way, which
 *  may begin or end at the service cell. */
export function laneOf(path, station, part) {
  const isService = (c) => same(c, station.service);
  const cells = path.filter((c) => !isService(c));
  if (!cells.length) return [];
  const isBeside = (c) => besides(c, station.service);
  const near = part === 'queue' ? cells.at(-1) : cells[0], far = part === 'queue' ? cells[0] : cells.at(-1);
  const isReversed = path.length > 1 && (isService(path[0]) ? part === 'queue' : isService(path.at(-1)) ? part === 'exit'
    : isBeside(far) && !isBeside(near));
  return isReversed ? cells.toReversed() : cells;
}

/** A lane with one cell more or less, as single clicks draw it: on its outer end. */
export function clicked(station, part, cell) {
  const lane = station[part];
  if (lane.some((c) => same(c, cell))) {
    const at = lane.findIndex((c) => same(c, cell));
    return part === 'queue' ? lane.slice(at + 1) : lane.slice(0, at);
  }
  const end = (part === 'queue' ? lane[0] : lane.at(-1)) ?? station.service;
  if (!besides(end, cell)) return lane;
  return part === 'queue' ? [cell, ...lane] : [...lane, cell];
}

/** Draws a lane: its cells become floor where they are no street, and leave other lanes. */
export function drawLane(drawing, station, part, cells) {
  drawing.setLane(station, part, []);
  for (const cell of cells) {
    const owner = drawing.ownerOf(cell);
    if (owner?.part === 'service') drawing.remove(owner.station);
    else if (owner) drawing.cut(owner, cell);
    if (!isStreet(drawing.get(...cell))) drawing.set(...cell, FLOOR);
  }
  drawing.setLane(station, part, cells);
}
