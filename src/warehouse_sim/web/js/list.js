// SPDX-License-Identifier: Apache-2.0
// The list of robots, blocked ones first, of which only the rows in sight exist; and the search.

import { $, make, press } from './dom.js';
import { STATE, STATUS } from './world.js';

const ROW = 30; // height [px]
const ORDER = [2, 1, 0]; // by status: idle, busy, blocked
const MOST_FOUND = 12; // units and items in the search's answer

export class RobotList {
  /** `select(name)` is called for what was clicked. */
  constructor(world, select) {
    Object.assign(this, { world, select, filter: '', text: '', chosen: null });
    this.box = $('robots');
    this.inside = make('div');
    this.box.append(this.inside);
    this.box.onscroll = () => this.draw();
    this.box.onkeydown = (event) => this.onKey(event);
    new ResizeObserver(() => this.draw()).observe(this.box);
    for (const button of $('filters').children) {
      button.onclick = () => this.setFilter(button.dataset.filter);
    }
    $('search').oninput = () => this.search($('search').value);
    $('search').onkeydown = (event) => event.key === 'Enter' && this.takeFirst();
  }

  setFilter(filter) {
    this.filter = filter;
    for (const button of $('filters').children) press(button, button.dataset.filter === filter);
    this.box.scrollTop = 0;
    this.refresh();
  }

  search(text) {
    this.text = text.toLowerCase().replace(/\s+/g, '').replace('robot', 'kiva');
    const { units, items, scenery } = this.world.scene;
    const names = this.text ? [...units, ...items, ...scenery] : [];
    const digits = this.text.match(/\d+$/)?.[0];
    // Shortest first, so that item7 comes before item70; 'unit 12' means storage_unit12.
    const found = names.filter((name) => name.includes(this.text))
      .sort((a, b) => a.length - b.length).slice(0, digits ? MOST_FOUND : MOST_FOUND / 2);
    $('found').replaceChildren(...found.map((name) => (
      make('button', { textContent: name, onclick: () => this.select(name) }))));
    $('found').hidden = found.length === 0;
    this.refresh();
  }

  takeFirst() {
    const first = this.rows.find((i) => this.nameOf(i) === this.text) ?? this.rows[0];
    const exact = this.world.indexOf.has(this.text) ? this.text : null;
    const name = exact ?? (first === undefined ? $('found').firstChild?.textContent : this.nameOf(first));
    if (name) this.select(name);
  }

  nameOf(i) {
    return `kiva${this.world.scene.robots[i]}`;
  }

  choose(name) {
    this.chosen = name;
    this.refresh();
  }

  /** Counts, sorts and draws anew. */
  refresh() {
    const { status, scene } = this.world;
    const counts = [0, 0, 0];
    for (const s of status) counts[s] += 1;
    for (const button of $('filters').children) {
      const { filter } = button.dataset;
      button.querySelector('b').textContent = filter === '' ? status.length : counts[filter];
    }
    const wanted = (i) => (this.filter === '' || status[i] === Number(this.filter))
      && (!this.text || this.nameOf(i).includes(this.text));
    this.rows = scene.robots.map((_, i) => i).filter(wanted)
      .sort((a, b) => ORDER[status[a]] - ORDER[status[b]] || scene.robots[a] - scene.robots[b]);
    this.inside.style.height = `${ROW * this.rows.length}px`;
    this.draw();
  }

  draw() {
    if (!this.rows) return;
    const first = Math.floor(this.box.scrollTop / ROW);
    const count = Math.ceil(this.box.clientHeight / ROW) + 1;
    const rows = this.rows.slice(first, first + count).map((i, at) => this.row(i, first + at));
    this.inside.replaceChildren(...rows);
  }

  row(i, at) {
    const { status, state, shelf } = this.world;
    const name = this.nameOf(i);
    const kind = STATUS[status[i]];
    const load = shelf[i] ? `carries ${shelf[i]}` : status[i] === 1 ? STATE[state[i]] : '';
    const out = make('div', { className: 'row', onclick: () => this.select(name) },
      make('span', { className: `badge ${kind}`, textContent: kind }), name,
      make('span', { className: 'load', textContent: load }));
    out.style.top = `${ROW * at}px`;
    out.dataset.name = name;
    out.setAttribute('role', 'option');
    out.setAttribute('aria-selected', String(name === this.chosen));
    return out;
  }

  onKey(event) {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step || !this.rows.length) return;
    event.preventDefault();
    const at = this.rows.findIndex((i) => this.nameOf(i) === this.chosen);
    const next = Math.max(0, Math.min(this.rows.length - 1, at + step));
    this.select(this.nameOf(this.rows[next]));
    this.box.scrollTop = Math.max(Math.min(this.box.scrollTop, next * ROW),
      (next + 1) * ROW - this.box.clientHeight);
  }
}
