// SPDX-License-Identifier: Apache-2.0
// A small live picture of a floor: storage units, stations and robots, seen from above.

import { token } from '../base/dom.js';
import { ask } from '../base/request.js';

const MOST = 1000; // rows of an answer
const ROBOT = 0.8; // diameter as it is drawn [m]
const MARGIN = 1.5; // [m]

/** Fetches where everything of a simulation is; throws as `ask` does. */
export async function look(url) {
  const [robots, units] = await Promise.all([
    ask('GET', `${url}api/v1/robots?limit=${MOST}`),
    ask('GET', `${url}api/v1/storage_units?limit=${MOST}`),
  ]);
  return { robots: (robots.robots ?? []).map(placeOf), units: (units.things ?? []).map(placeOf) };
}

function placeOf(thing) {
  const { x, y } = thing.pose ?? thing;
  return { x, y, isBusy: Boolean(thing.storage_unit) || thing.status === 'BUSY' };
}

/** Draws what look() returned. */
export function paint(canvas, { robots, units }) {
  const all = [...robots, ...units];
  const scale = devicePixelRatio;
  canvas.width = canvas.clientWidth * scale;
  canvas.height = canvas.clientHeight * scale;
  if (!all.length) return;
  const [west, east] = rangeOf(all.map(({ x }) => x));
  const [south, north] = rangeOf(all.map(({ y }) => y));
  const zoom = Math.min(canvas.width / (east - west), canvas.height / (north - south));
  const pen = canvas.getContext('2d');
  const left = (canvas.width - zoom * (east - west)) / 2;
  const top = (canvas.height - zoom * (north - south)) / 2;
  const at = ({ x, y }) => [left + (x - west) * zoom, top + (north - y) * zoom];
  pen.fillStyle = token('edge');
  for (const unit of units) {
    const [x, y] = at(unit);
    pen.fillRect(x - 0.4 * zoom, y - 0.4 * zoom, 0.8 * zoom, 0.8 * zoom);
  }
  for (const robot of robots) {
    pen.fillStyle = token(robot.isBusy ? 'moving' : 'resting');
    pen.beginPath();
    pen.arc(...at(robot), Math.max(ROBOT / 2 * zoom, 2 * scale), 0, 2 * Math.PI);
    pen.fill();
  }
}

function rangeOf(numbers) {
  const low = Math.min(...numbers) - MARGIN;
  return [low, Math.max(Math.max(...numbers) + MARGIN, low + 2 * MARGIN)];
}
