// SPDX-License-Identifier: Apache-2.0
// The list of robots, those that need help first: only the rows in sight exist; and the search.

import { $, make, on, press, setText } from '../base/dom.js';
import { RobotMode } from '../base/message_enums.js';
import { found, rowsOf, wanted } from '../base/search.js';
import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';
import { ACTIVITY, ACTIVITY_CLASS, MODE_WORDS, shownName, STATE } from '../base/words.js';

const BIG = matchMedia('(pointer: coarse), (max-width: 760px)'); // as in floor.css

export class RobotList {
  /** `select(name)` is called for what was clicked, `find(name)` for what was searched, `unknown(text)` for what is the name of nothing
   *  ('': nothing is searched that way); `modeOf(id)` has who commands a robot, if a coordinator runs. */
  constructor(world, select, find, unknown, modeOf) {
    Object.assign(this, { world, select, find, unknown, modeOf, filter: '', text: '', chosen: null, rows: [] });
    this.box = $('robots');
    this.inside = make('div');
    this.box.append(this.inside);
    on(this.box, 'scroll', () => this.draw());
    on(this.box, 'keydown', (event) => this.onKey(event));
    new ResizeObserver(() => this.refresh()).observe(this.box);
    for (const button of $('filters').children) {
      on(button, 'click', () => this.setFilter(button.dataset.filter));
    }
    on($('search'), 'input', () => this.search($('search').value));
    on($('search'), 'keydown', ({ key }) => key === 'Enter' && this.takeFirst());
  }

  /** Height of a row [px]. */
  get rowHeight() {
    return BIG.matches ? 44 : 30;
  }

  setFilter(filter) {
    this.filter = filter;
    for (const button of $('filters').children) press(button, button.dataset.filter === filter);
    this.box.scrollTop = 0;
    this.refresh();
  }

  search(text) {
    this.text = wanted(text);
    const { units, items, scenery, stations } = this.world.scene;
    const names = found([...new Set([...stations.map(({ name }) => name), ...units, ...items, ...scenery])], this.text);
    $('found').replaceChildren(...names.map((name) => (
      make('button', { textContent: shownName(name), click: () => this.find(name) }))));
    $('found').hidden = names.length === 0;
    this.refresh();
    this.unknown(names.length || this.rows.length ? '' : text);
  }

  /** Searches for what an address asks for; '': for what is typed. */
  ask(encoded) {
    if (encoded) $('search').value = decoded(encoded);
    this.search($('search').value);
  }

  /** Pieces of a SKU by the number of the unit on which they lie, in place of what was found. */
  showPieces(sku, units) {
    if (!sku) return;
    const all = [...units.values()].reduce((sum, pieces) => sum + pieces, 0);
    $('found').replaceChildren(make('p', { className: 'dim', textContent: all
      ? tr`${sku}: ${number(all)} pieces on ${number(units.size)} units` : tr`no pieces of ${sku}` }),
    ...[...units].map(([unit, pieces]) => make('button', {
      textContent: tr`unit ${unit}: ${number(pieces)}`, click: () => this.find(`storage_unit${unit}`) })));
    $('found').hidden = false;
    this.refresh();
  }

  takeFirst() {
    const name = this.world.indexOf.has(this.text) ? this.text : this.rows.length ? this.nameOf(this.rows[0]) : '';
    if (name) this.find(name);
    else $('found').querySelector('button')?.click();
  }

  nameOf(i) {
    return `kiva${this.world.scene.robots[i]}`;
  }

  choose(name) {
    this.chosen = name;
    this.refresh();
  }

  /** Counts and sorts the robots, and draws the rows. */
  refresh() {
    const { activity, scene } = this.world, isKnown = 'protocol' in scene;
    const counts = ACTIVITY.map(() => 0);
    for (const a of activity) counts[a] += 1;
    for (const button of $('filters').children) {
      const { filter } = button.dataset;
      setText(button.querySelector('b'), isKnown ? number(filter === '' ? activity.length : counts[filter]) : '');
    }
    this.rows = rowsOf(this.world, this.text, this.filter);
    this.box.hidden = !this.rows.length && !$('found').hidden; // room for what was found
    this.inside.style.height = `${this.rowHeight * this.rows.length}px`;
    this.draw();
  }

  draw() {
    const first = Math.floor(this.box.scrollTop / this.rowHeight);
    const count = Math.ceil(this.box.clientHeight / this.rowHeight) + 1;
    const rows = this.rows.slice(first, first + count), { children } = this.inside;
    rows.forEach((i, k) => this.drawRow(children[k], i, first + k));
    while (children.length > rows.length) this.inside.lastChild.remove();
  }

  /** A row that says the same already stays. */
  drawRow(old, i, at) {
    const { activity, state, shelf } = this.world;
    const shows = [i, at, activity[i], state[i], shelf[i], this.byPerson(i), this.nameOf(i) === this.chosen].join();
    if (old?.shows === shows) return;
    const row = Object.assign(this.row(i, at), { shows });
    if (old) old.replaceWith(row);
    else this.inside.append(row);
  }

  row(i, at) {
    const { activity, state, shelf } = this.world;
    const name = this.nameOf(i);
    const does = activity[i], byPerson = this.byPerson(i);
    const load = shelf[i] ? tr`unit ${shelf[i]}` : state[i] ? STATE[state[i]] : '';
    const out = make('div', { className: 'row', click: () => this.select(name) },
      make('span', { className: `badge ${ACTIVITY_CLASS[does]}`, textContent: ACTIVITY[does] }), name,
      ...byPerson ? [make('span', { className: 'badge', textContent: byPerson })] : [],
      make('span', { className: 'load', textContent: load }));
    Object.assign(out.style, { top: `${this.rowHeight * at}px`, height: `${this.rowHeight}px` });
    out.dataset.name = name;
    out.setAttribute('role', 'option');
    out.setAttribute('aria-selected', String(name === this.chosen));
    return out;
  }

  /** The word for a robot's mode where the coordinator does not command it, or ''. */
  byPerson(i) {
    const mode = this.modeOf(this.world.scene.robots[i]) ?? RobotMode.AUTOMATIC;
    return mode === RobotMode.AUTOMATIC ? '' : MODE_WORDS[mode];
  }

  onKey(event) {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!step || !this.rows.length) return;
    event.preventDefault();
    const at = this.rows.findIndex((i) => this.nameOf(i) === this.chosen);
    const next = Math.max(0, Math.min(this.rows.length - 1, at + step));
    this.select(this.nameOf(this.rows[next]));
    this.box.scrollTop = Math.max(Math.min(this.box.scrollTop, next * this.rowHeight),
      (next + 1) * this.rowHeight - this.box.clientHeight);
  }
}

function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch { // a lone %
    return text;
  }
}
