// SPDX-License-Identifier: Apache-2.0
// A layout as it is drawn, on paper without an end: a cell is [column, row], rows upwards, and
// numbers may be negative. The file counts from the lowest cell that is drawn; see text.js.

import { FLOOR, isLetter, isPassable, isStreet, NOTHING, PLACE } from './characters.js';

const SPARE = 16; // cells that the paper grows at once
const MOST = 2000; // cells along an edge
const LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZ';
const EMPTY = NOTHING.charCodeAt(0);

export const same = (a, b) => a[0] === b[0] && a[1] === b[1];
export const besides = (a, b) => Math.abs(a[0] - b[0]) + Math.abs(a[1] - b[1]) === 1;

export class Drawing {
  constructor() {
    Object.assign(this, { left: 0, bottom: 0, width: 0, height: 0, cells: new Uint8Array(0) });
    Object.assign(this, { name: '', spacing: 1, stations: [], elevators: [], units: 0.85, isShare: true });
    // robots, units: a count, or a list of cells. items: null is four a storage unit.
    Object.assign(this, { robots: 0, items: null, stock: '', skus: '', policies: {}, measured: '', building: '', at: null });
    this.owners = null;
  }

  clone() {
    const out = Object.assign(new Drawing(), this);
    out.cells = this.cells.slice();
    out.stations = this.stations.map((s) => ({ ...s, queue: [...s.queue], exit: [...s.exit], short_cuts: [...s.short_cuts] }));
    for (const what of ['robots', 'units']) if (Array.isArray(out[what])) out[what] = [...out[what]];
    out.owners = null;
    return out;
  }

  index(column, row) {
    const x = column - this.left, y = row - this.bottom;
    return x >= 0 && y >= 0 && x < this.width && y < this.height ? y * this.width + x : -1;
  }

  get(column, row) {
    const i = this.index(column, row);
    return i < 0 ? NOTHING : String.fromCharCode(this.cells[i]);
  }

  /** Draws a character, and keeps stations, lanes and lists true to it. False: off the paper. */
  set(column, row, char) {
    const before = this.get(column, row);
    if (before === char && !isLetter(char)) return true;
    if (!this.holds(column, row) && !this.grow(column, row)) return false;
    this.leave([column, row], char);
    if (isLetter(char)) this.station(char, [column, row]);
    this.cells[this.index(column, row)] = char.charCodeAt(0);
    return true;
  }

  holds(column, row) {
    return this.index(column, row) >= 0;
  }

  /** More paper, so that it holds a cell; false if that would be too much. */
  grow(column, row) {
    const empty = !this.width;
    const left = empty ? column - SPARE : Math.min(this.left, column < this.left ? column - SPARE : column);
    const bottom = empty ? row - SPARE : Math.min(this.bottom, row < this.bottom ? row - SPARE : row);
    const right = Math.max(empty ? column + SPARE : this.left + this.width, column + (column >= this.left + this.width ? SPARE : 1));
    const top = Math.max(empty ? row + SPARE : this.bottom + this.height, row + (row >= this.bottom + this.height ? SPARE : 1));
    if (right - left > MOST || top - bottom > MOST) return false;
    const cells = new Uint8Array((right - left) * (top - bottom)).fill(EMPTY);
    for (let y = 0; y < this.height; y++) {
      const at = (y + this.bottom - bottom) * (right - left) + this.left - left;
      cells.set(this.cells.subarray(y * this.width, (y + 1) * this.width), at);
    }
    Object.assign(this, { left, bottom, width: right - left, height: top - bottom, cells });
    return true;
  }

  /** What was at a cell makes way for a character. */
  leave(cell, char) {
    const owner = this.ownerOf(cell), isLaneStill = isStreet(char) && !isLetter(char);
    if (owner?.part === 'service') {
      if (char !== owner.station.key && !(isLaneStill && !isLetter(owner.station.key))) this.remove(owner.station);
    } else if (owner && !isLaneStill) this.cut(owner, cell);
    this.prune(cell, char);
  }

  /** Lists of robots and units keep to cells where these can be. */
  prune(cell, char) {
    if (Array.isArray(this.robots) && !isPassable(char)) this.robots = without(this.robots, cell);
    if (Array.isArray(this.units) && char !== PLACE) this.units = without(this.units, cell);
  }

  /** Takes a cell out of a lane, and what lies beyond it as the station sees it. */
  cut({ station, part }, cell) {
    const lane = station[part], at = lane.findIndex((c) => same(c, cell));
    this.setLane(station, part, part === 'queue' ? lane.slice(at + 1) : lane.slice(0, at));
  }

  // --- stations

  /** {station, part} to which a cell belongs, part: service, queue or exit; or undefined. */
  ownerOf([column, row]) {
    if (!this.owners) {
      this.owners = new Map();
      for (const station of this.stations) {
        for (const part of ['queue', 'exit']) for (const c of station[part]) this.owners.set(`${c}`, { station, part });
        this.owners.set(`${station.service}`, { station, part: 'service' });
      }
    }
    return this.owners.get(`${column},${row}`);
  }

  /** The station of a letter, which now is at a cell; its lane stays behind if it moved. */
  station(key, cell, like = {}) {
    let station = this.stations.find((s) => s.key === key);
    if (station && same(station.service, cell)) return station;
    if (station) {
      const [column, row] = station.service;
      if (this.holds(column, row)) this.cells[this.index(column, row)] = FLOOR.charCodeAt(0);
      Object.assign(station, { service: cell, queue: [], exit: [], short_cuts: [] });
    } else {
      const kind = like.kind ?? 'pick';
      station = { key, name: this.freeName(kind), kind, service: cell, queue: [], exit: [], short_cuts: [], settings: { ...like.settings } };
      this.stations.push(station);
    }
    this.owners = null;
    return station;
  }

  freeName(kind) {
    const names = new Set(this.stations.map((s) => s.name));
    for (let n = 1; ; n++) if (!names.has(`${kind}${n}`)) return `${kind}${n}`;
  }

  /** The next letter that no station has; then AA, AB, …. */
  freeKey() {
    const keys = new Set(this.stations.map((s) => s.key));
    const letter = [...LETTERS].find((l) => !keys.has(l));
    if (letter) return letter;
    for (const a of LETTERS) for (const b of LETTERS) if (!keys.has(a + b)) return a + b;
    return '';
  }

  /** Puts a station with the next free key at a cell. */
  addStation(cell, like) {
    const key = this.freeKey(), [column, row] = cell;
    if (!key || !this.set(column, row, FLOOR)) return null;
    const old = this.ownerOf(cell);
    if (old?.part === 'service') this.remove(old.station);
    else if (old) this.cut(old, cell);
    const station = this.station(key, cell, like);
    if (isLetter(key)) this.cells[this.index(column, row)] = key.charCodeAt(0);
    return station;
  }

  remove(station) {
    const [column, row] = station.service;
    if (this.get(column, row) === station.key) this.cells[this.index(column, row)] = FLOOR.charCodeAt(0);
    this.stations = this.stations.filter((s) => s !== station);
    this.owners = null;
  }

  setLane(station, part, cells) {
    if (part === 'queue') station.short_cuts = station.short_cuts.filter((cut) => this.isAhead(station, cells, cut));
    station[part] = cells;
    this.owners = null;
  }

  /** Whether a short cut leads farther ahead in a new queue of a station, or into it. */
  isAhead({ queue, service }, cells, [from, to]) {
    const way = [...cells, service], begin = indexOf(way, from);
    return indexOf(way, to) > Math.max(0, begin + 1) && (begin >= 0 || indexOf(queue, from) < 0);
  }

  // --- sums

  /** {left, bottom, right, top}, the last two beyond what is drawn; null if nothing is. */
  bounds() {
    let [left, bottom, right, top] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let y = 0, i = 0; y < this.height; y++) {
      for (let x = 0; x < this.width; x++, i++) {
        if (this.cells[i] === EMPTY) continue;
        left = Math.min(left, x);
        right = Math.max(right, x);
        bottom = Math.min(bottom, y);
        top = y;
      }
    }
    if (right < 0) return null;
    return { left: left + this.left, bottom: bottom + this.bottom, right: right + this.left + 1, top: top + this.bottom + 1 };
  }

  count(char) {
    const code = char.charCodeAt(0);
    return this.cells.reduce((sum, c) => sum + (c === code), 0);
  }

  get places() {
    return this.count(PLACE);
  }

  get unitCount() {
    if (Array.isArray(this.units)) return this.units.length;
    return this.isShare ? Math.round(this.units * this.places) : this.units;
  }

  get robotCount() {
    return Array.isArray(this.robots) ? this.robots.length : this.robots;
  }

  get itemCount() {
    return this.stock ? 0 : this.items ?? 4 * this.unitCount;
  }
}

const indexOf = (cells, cell) => cells.findIndex((c) => same(c, cell));
const without = (cells, cell) => cells.filter((c) => !same(c, cell));
