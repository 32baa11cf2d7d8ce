// SPDX-License-Identifier: Apache-2.0
// The text of a layout file from a drawing, and a drawing from the server's JSON. Text is read by
// the server alone.

import { isLetter, NOTHING } from './characters.js';
import { Drawing } from './drawing.js';

const NONE = { left: 0, bottom: 0, right: 1, top: 1 };

/** The JSON of a drawing, as the server's drawing_json has that of a file; `origin` is the cell that becomes
 *  [0, 0]. */
export function jsonOf(drawing) {
  const { left, bottom, right, top } = drawing.bounds() ?? NONE;
  const moved = ([column, row]) => [column - left, row - bottom];
  const places = (value) => (Array.isArray(value) ? value.map(moved) : value);
  const floor = [];
  for (let row = top - 1; row >= bottom; row--) {
    let line = '';
    for (let column = left; column < right; column++) line += drawing.get(column, row);
    floor.push(line);
  }
  return {
    origin: [left, bottom],
    name: drawing.name,
    spacing: drawing.spacing,
    floor,
    stations: drawing.stations.map((s) => stationAt(s, moved)),
    elevators: drawing.elevators.map((e) => ({ ...e, cells: places(e.cells) })),
    storage_units: places(drawing.units),
    is_share: drawing.isShare,
    robots: places(drawing.robots),
    items: drawing.itemCount,
    counts_items: drawing.items === null,
    stock: drawing.stock,
    skus: drawing.skus,
    policies: drawing.policies,
    measured: drawing.measured,
    building: drawing.building,
    at: drawing.at && [drawing.at[0] + left * drawing.spacing, drawing.at[1] + bottom * drawing.spacing],
  };
}

/** A drawing of such JSON, its lowest cell at [0, 0] or where it was. */
export function drawingOf(json) {
  const out = new Drawing(), [left, bottom] = json.origin ?? [0, 0];
  const moved = ([column, row]) => [column + left, row + bottom];
  const places = (value) => (Array.isArray(value) ? value.map(moved) : value);
  const height = json.floor.length, width = json.floor[0].length;
  Object.assign(out, { left, bottom, width, height, cells: new Uint8Array(width * height) });
  json.floor.forEach((line, i) => {
    for (let x = 0; x < width; x++) out.cells[(height - 1 - i) * width + x] = line.charCodeAt(x);
  });
  const { name, spacing, stock, skus = '', policies, measured = '', building } = json;
  Object.assign(out, { name, spacing, stock, skus, policies, measured, building, isShare: json.is_share });
  out.stations = json.stations.map((s) => stationAt(s, moved));
  out.elevators = (json.elevators ?? []).map((e) => ({ ...e, cells: places(e.cells) }));
  out.units = places(json.storage_units);
  out.robots = places(json.robots);
  out.items = json.counts_items ? null : json.items;
  // A hall without `at` is centred about the drawing; what is drawn at its edge must not move it.
  const centre = building ? [-((width - 1) >> 1) * spacing, -((height - 1) >> 1) * spacing] : null;
  const at = json.at ?? centre;
  out.at = at && [at[0] - left * spacing, at[1] - bottom * spacing];
  return out;
}

/** {text, origin}: a layout file, and the cell of the drawing that is [0, 0] in it. */
export function textOf(drawing) {
  const json = jsonOf(drawing), flow = JSON.stringify;
  const lines = ['layout: 1'];
  if (json.name) lines.push(`name: ${flow(json.name)}`);
  lines.push(`spacing: ${json.spacing}`);
  if (json.building) lines.push(`building: ${flow(json.building)}`);
  if (json.at) lines.push(`at: ${flow(json.at)}`);
  // YAML takes the first line's leading spaces for indentation, unless a number declares it.
  lines.push(json.floor[0].startsWith(NOTHING) ? 'floor: |2' : 'floor: |', ...json.floor.map((line) => `  ${line}`));
  if (json.stations.length) lines.push('stations:', ...json.stations.map((s) => `  ${keyText(s.key)}: ${flow(entryOf(s))}`));
  if (json.elevators.length) lines.push('elevators:', ...json.elevators.map(({ name, ...e }) => `  ${keyText(name)}: ${flow(e)}`));
  lines.push(`storage_units: ${unitsOf(json)}`, `robots: ${flow(json.robots)}`);
  lines.push(json.stock ? `items: {stock: ${flow(json.stock)}${json.skus ? `, skus: ${flow(json.skus)}` : ''}}` : `items: ${json.items}`);
  if (Object.keys(json.policies).length) lines.push(`policies: ${flow(json.policies)}`);
  if (json.measured) lines.push(`measured: ${flow(json.measured)}`);
  return { text: `${lines.join('\n')}\n`, origin: json.origin };
}

/** A station whose cells are moved. */
export function stationAt(s, moved) {
  const cuts = (s.short_cuts ?? []).map((cut) => cut.map(moved));
  return { ...s, service: moved(s.service), queue: s.queue.map(moved), exit: s.exit.map(moved), short_cuts: cuts };
}

const keyText = (key) => (/^[A-Za-z]\w*$/.test(key) ? key : JSON.stringify(key));

/** A share of 1 is not a count of 1. */
function unitsOf({ storage_units: units, is_share: isShare }) {
  return isShare && Number.isInteger(units) ? units.toFixed(1) : JSON.stringify(units);
}

function entryOf({ key, name, kind, service, queue, exit, short_cuts: cuts, settings }) {
  return {
    name,
    kind,
    ...(isLetter(key) ? {} : { service }),
    ...(queue.length ? { queue } : {}),
    ...(exit.length ? { exit } : {}),
    ...(cuts.length ? { short_cuts: cuts } : {}),
    ...settings,
  };
}
