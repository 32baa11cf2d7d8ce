// SPDX-License-Identifier: Apache-2.0
// Draws what a person at a station has to do. Its elements stay: the focus and a finger on its way find
// what they aimed at.

import { $ } from '../base/dom.js';
import { StationMode } from '../base/message_enums.js';
import { tr } from '../language/texts.js';
import { UnitDrawing } from './unit_drawing.js';
import { Wall } from './wall.js';

const LONG = 13; // characters of a SKU that may be broken into lines
const SETTLES = 700; // what was drawn just now is not meant by a finger on its way [ms]

export class View {
  constructor(bench) {
    Object.assign(this, { bench, shown: '', drawnAt: 0, pieces: 0, link: 'away' });
    this.front = new UnitDrawing($('front'));
    this.wall = new Wall($('wall'));
    $('name').textContent = bench.name;
    document.title = tr`${bench.name}: Kiva warehouse`;
  }

  /** Whether what is shown has been there long enough to be meant. */
  get isSettled() {
    return performance.now() - this.drawnAt > SETTLES;
  }

  show() {
    const { bench } = this, { task, state } = bench;
    $('unit').textContent = state?.shelf_id ? tr`unit ${state.shelf_id}` : '';
    for (const id of ['take', 'buttons']) $(id).hidden = !task && !(id === 'buttons' && bench.undoable);
    $('put').hidden = state?.mode !== StationMode.MANUAL || !bench.isPicking || !state.slots;
    $('idle').hidden = Boolean(task);
    $('work').dataset.shows = task ? bench.isPicking ? 'pick' : 'store' : 'idle';
    $('undo').disabled = !bench.undoable;
    if (task) this.showTask(task);
    else this.showIdle();
    this.showTotes(task);
    this.showLink();
  }

  showTask(task) {
    const { bench } = this, { sequence, sku, quantity, item } = task, { hand, placed } = bench.counted;
    const key = JSON.stringify([sequence, quantity]);
    if (key !== this.shown) Object.assign(this, { shown: key, drawnAt: performance.now(), pieces: quantity });
    const isPicking = bench.isPicking;
    put('amount', `${isPicking ? tr`Take` : tr`Put in`} ${quantity} ×`);
    put('sku', sku);
    $('sku').classList.toggle('long', sku.length > LONG);
    put('bin', isPicking ? tr`from bin ${item}` : tr`into bin ${item}`);
    put('progress', hand + placed ? tr`${hand + placed} of ${quantity} counted${placed ? tr`, ${placed} in the tote` : ''}` : '');
    const more = bench.tasks.length - 1;
    put('next', more ? tr`then ${more} more from this unit` : tr`the last one of this unit`);
    this.front.show(bench.state.shelf_id, item, quantity);
    this.showCount(task);
  }

  showCount({ quantity, tote }) {
    const where = tote ? tr` in tote ${tote}` : tr` put in`, { pieces } = this;
    const all = quantity === 1 ? tr`1${where}` : tr`All ${quantity}${where}`;
    put('confirm', pieces === quantity ? all : tr`${pieces} of ${quantity}${where}`);
    put('count', pieces);
    for (const id of ['confirm', 'short', 'damaged']) $(id).hidden = false;
    $('confirm').parentElement.querySelector('.count').hidden = quantity === 1;
    $('fewer').disabled = pieces <= 1;
    $('more').disabled = pieces >= quantity;
    $('confirm').disabled = !this.bench.isPicking && pieces !== quantity; // a bundle goes in whole
  }

  /** Changes how many pieces the buttons are about. */
  step(by) {
    const { task } = this.bench;
    if (!task) return;
    this.pieces = Math.max(1, Math.min(task.quantity, this.pieces + by));
    this.showCount(task);
  }

  showIdle() {
    const { bench } = this, { state } = bench;
    this.shown = '';
    for (const id of ['confirm', 'short', 'damaged']) $(id).hidden = true;
    document.querySelector('#buttons .count').hidden = true;
    const [text, more, button] = this.idle(state);
    put('idle-text', text);
    put('idle-more', more);
    $('by-hand').hidden = !button;
    put('by-hand', button);
  }

  /** [text, what to do, the button's text] where there is no task. */
  idle(state) {
    const { bench, link } = this, kept = bench.outbox.entries.length;
    if (!state) return [link === 'live' ? tr`There is no station ${bench.name}.` : tr`Nothing is known yet.`, '', ''];
    if (state.mode !== StationMode.MANUAL) return [tr`${state.name} works automatically.`, '', tr`Work manually`];
    if (kept && link !== 'live') return [tr`All is done here.`, tr`The next storage unit comes when the network is back.`, ''];
    if (kept) return [tr`All is done here.`, tr`Sending it to the server …`, ''];
    const back = tr`Back to automatic`;
    if (!state.open) return [tr`The station is closed.`, '', back];
    const { length: coming } = state.inbound;
    if (!coming) return [tr`Nothing to be done.`, tr`No storage unit is on its way.`, back];
    return [tr`The next storage unit is on its way.`, coming > 1 ? tr`${coming} are coming.` : '', back];
  }

  showTotes(task) {
    put('tote', task?.tote ? tr`tote ${task.tote}` : tr`no tote`);
    put('order', task?.reference ?? '');
    $('put').dataset.lit = String(Boolean(task?.tote));
    if (!$('put').hidden) this.wall.show(this.bench.totes, task?.quantity ?? 0);
  }

  showLink(link = this.link) {
    this.link = link;
    const { outbox } = this.bench, kept = outbox.entries.length, isStuck = kept > 0 && outbox.isStuck;
    const isAway = link === 'away' || isStuck;
    $('link').dataset.state = isAway ? 'away' : link;
    const waiting = kept ? tr`: ${kept} kept here, nothing is lost` : '';
    put('link', isAway ? tr`offline${waiting}` : link === 'idle' ? tr`no shift is running${waiting}` : tr`live`);
  }

  /** Shows what became of something, until the next result. */
  say({ ok, text }) {
    put('told', text);
    $('told').dataset.kind = ok ? 'done' : 'refused';
  }
}

/** Changes a text only where it is another one: a screen reader hears each change. */
function put(id, text) {
  if ($(id).textContent !== String(text)) $(id).textContent = text;
}
