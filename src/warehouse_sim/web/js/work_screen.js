// SPDX-License-Identifier: Apache-2.0
// What a person at a station has to do with the unit that is there, big enough for a finger.

import { get, post, put } from './api.js';
import { $, make } from './dom.js';
import { within } from './world.js';

const SIDE = 0.8, TOP = 1.8; // of a storage unit [m]
const SCALE = 250; // of its drawing [px/m]
const SVG = 'http://www.w3.org/2000/svg';

export class WorkScreen {
  constructor() {
    Object.assign(this, { name: '', shown: null, station: null });
  }

  /** The station of that name has the screen; '': none. */
  choose(name) {
    Object.assign(this, { name, shown: null, station: null });
    $('screen').hidden = !name;
    $('overview').hidden = Boolean(name);
    if (name) $('screen').replaceChildren(this.head(name, 'looking …'));
  }

  /** Takes the stations in as they are now. */
  take(stations) {
    if (!this.name) return;
    this.station = stations.find(({ name }) => name === this.name);
    const { mode, shelf_id: unit, picks = [], inbound, open } = this.station ?? {};
    const key = JSON.stringify([mode, unit, picks, inbound?.length > 0, open]);
    if (this.shown === key) return; // a finger may be on its way to a button
    this.shown = key;
    if (!this.station) this.say(`there is no station ${this.name}`);
    else if (mode !== 'MANUAL') this.say(`${this.name} works by itself.`, this.byHand('Work by hand', 'MANUAL'));
    else if (!picks.length) this.say(this.waitsFor(), this.byHand('Let it work by itself', 'AUTOMATIC'));
    else this.ask(picks);
  }

  waitsFor() {
    if (!this.station.open) return 'The station is closed.';
    return this.station.inbound.length ? 'The next storage unit is on its way.' : 'Nothing to be done.';
  }

  byHand(text, mode) {
    return make('button', { textContent: text, click: () => this.send(put(`/stations/${this.name}`, { open: this.station.open, mode })) });
  }

  head(title, text = '') {
    return make('header', {}, make('h1', { textContent: title }), make('span', { className: 'dim', textContent: text }),
      make('a', { className: 'button', href: '#', textContent: 'All stations' }));
  }

  say(text, ...buttons) {
    $('screen').replaceChildren(this.head(this.name), make('div', { className: 'idle-text' }, make('p', { className: 'task', textContent: text })),
      make('div', { className: 'buttons' }, ...buttons));
  }

  ask(picks) {
    const [{ sku, quantity, item, reference }] = picks;
    const isPicking = this.station.kind === 'PICK';
    const unit = this.station.shelf_id;
    this.count = quantity;
    const count = make('b');
    const button = (kind, text, act) => make('button', { className: kind, textContent: text, click: () => this.send(act()) });
    const report = (damaged, pieces) => post(`/stations/${this.name}/short`, { sku, quantity: pieces, damaged });
    const confirm = button('confirm strong', 'Confirm', () => post(`/stations/${this.name}/confirm`, { sku, quantity: this.count }));
    // Who finds too few has an empty bin before them, whatever the books say.
    const short = button('short', 'Short', async () => report(false, isPicking ? await booked(sku, item) : this.count));
    short.title = isPicking ? 'no more of them are in the bin' : 'so many did not come';
    const damaged = button('damaged', 'Damaged', () => report(true, this.count));
    const set = (number) => {
      this.count = Math.max(1, Math.min(quantity, number));
      count.textContent = this.count;
      confirm.disabled = !isPicking && this.count !== quantity; // a bundle goes in whole
    };
    set(quantity);
    const step = (text, by, label) => make('button', { textContent: text, ariaLabel: label, click: () => set(this.count + by) });
    const left = picks.length > 1 ? `then ${picks.length - 1} more` : 'the last one at this unit';
    const shelf = document.createElementNS(SVG, 'svg');
    drawUnit(shelf, unit, item, quantity);
    $('screen').replaceChildren(
      this.head(`${this.name}: storage unit ${unit}`, left), shelf,
      make('div', {}, make('p', { className: 'task', textContent: `${isPicking ? 'Take' : 'Put in'} ${quantity} × ${sku}` }),
        make('p', { textContent: reference ? `bin ${item}, for ${reference}` : `bin ${item}` }),
        make('div', { className: 'count' }, step('−', -1, 'one piece fewer'), count, step('+', 1, 'one piece more'), 'pieces'),
        make('p', { id: 'screen-answer', className: 'answer', hidden: true })),
      make('div', { className: 'buttons' }, confirm, short, damaged));
  }

  /** Waits for what was asked of the server; what comes next the stations tell. */
  async send(sent) {
    const buttons = $('screen').querySelectorAll('button:not(:disabled)');
    for (const button of buttons) button.disabled = true;
    try {
      await sent;
    } catch (error) {
      if ($('screen-answer')) Object.assign($('screen-answer'), { hidden: false, textContent: error.message });
    }
    for (const button of buttons) button.disabled = false;
  }
}

/** Pieces in a bin, by the books. */
async function booked(sku, item) {
  const { places } = await get(`/stock?limit=1000&sku=${encodeURIComponent(sku)}`);
  return places.find((place) => place.item === item)?.quantity ?? 1;
}

/** The unit's front with its bins, of which one is lit. */
async function drawUnit(svg, unit, lit, quantity) {
  svg.setAttribute('class', 'shelf');
  svg.setAttribute('viewBox', `${-SCALE * SIDE / 2 - 4} ${-SCALE * TOP - 4} ${SCALE * SIDE + 8} ${SCALE * TOP + 8}`);
  svg.setAttribute('aria-label', `storage unit ${unit}, ${lit} is lit`);
  const bins = await binsOf(unit).catch(() => []);
  const draw = (className, x, y, width, height) => (
    `<rect class="${className}" x="${SCALE * (x - width / 2)}" y="${-SCALE * (y + height)}" width="${SCALE * width}" height="${SCALE * height}"/>`);
  const levels = [...new Set(bins.map(({ z }) => z))];
  const isLit = ({ name }) => name === lit;
  // The nearer ones last; the lit one on top.
  const order = bins.sort((a, b) => isLit(a) - isLit(b) || a.depth - b.depth);
  const [one] = order.filter(isLit);
  svg.innerHTML = draw('', 0, 0, SIDE, TOP) + levels.map((z) => draw('plate', 0, z - 0.04, SIDE, 0.02)).join('')
    + order.map((bin) => draw(isLit(bin) ? 'bin lit' : 'bin', bin.x, bin.z - 0.02, 0.16, 0.22)).join('')
    + (one ? `<text x="${SCALE * one.x}" y="${-SCALE * (one.z + 0.09)}">${quantity}</text>` : '');
}

/** [{name, x, z, depth}] of a unit's bins, in its own frame [m], seen from its front. */
async function binsOf(unit) {
  const [place, { things }] = await Promise.all([
    get(`/storage_units/${unit}`), get(`/items?limit=100&storage_unit=storage_unit${unit}`)]);
  const frame = planarOf(place.pose);
  const back = within([0, 0, 0, -frame[3]], [-frame[0], -frame[1], -frame[2], 0]);
  return things.map(({ name, pose }) => {
    const [depth, x, z] = within([...back.slice(0, 3), -frame[3]], planarOf(pose));
    return { name, x, z: Math.round(100 * z) / 100, depth };
  });
}

function planarOf({ x, y, z, qx, qy, qz, qw }) {
  return [x, y, z, Math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))];
}
