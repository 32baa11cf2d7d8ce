// SPDX-License-Identifier: Apache-2.0
// The tasks of a person at a station: the server's last state, less what was reported since. Work
// continues without a network for the tasks that are known of the present unit.

import { PickOutcome, StationMode } from '../base/message_enums.js';
import { tr } from '../language/texts.js';
import { meaningOf } from './codes.js';
import { newId } from './outbox.js';

const FLASH = 6000; // duration for which a tote shows that it is complete [ms]
const COMPLETE = tr`take away, set up a new one`;
const WRITE_OFF_UNDO = 10_000; // how long a write-off can be taken back [ms]

export class Bench {
  /** shelf: keeps {told: the state, count, last} over a reload. */
  constructor(name, shelf, outbox) {
    Object.assign(this, { name, shelf, outbox, settled: new Map(), changed: new Map(), stations: [name] });
    this.state = shelf.read('told');
    this.count = shelf.read('count') ?? { sequence: 0, hand: 0, placed: 0 };
    this.last = shelf.read('last');
  }

  // --- what there is

  get isPicking() {
    return this.state?.kind === 'PICK';
  }

  /** Reports whose results have not come from the server: {sequence: quantity}. */
  get pending() {
    const reports = this.outbox.entries.filter(({ kind }) => kind === 'report');
    const kept = reports.map(({ sequence, body }) => [sequence, body.outcome === PickOutcome.DONE ? body.quantity : 0]);
    return new Map([...this.settled, ...kept]);
  }

  /** The tasks at the present unit, the next first. */
  get tasks() {
    if (this.state?.mode !== StationMode.MANUAL) return [];
    const { pending } = this;
    return this.state.picks.filter(({ sequence }) => !pending.has(sequence));
  }

  get task() {
    return this.tasks[0] ?? null;
  }

  /** Pieces of the task in the hand and in the tote. */
  get counted() {
    const { sequence, hand, placed } = this.count;
    return sequence === this.task?.sequence ? { hand, placed } : { hand: 0, placed: 0 };
  }

  /** What each place of a tote shows, from 1 to the station's slots. */
  get totes() {
    const { pending, task } = this;
    const by = new Map((this.state?.totes ?? []).map((tote) => [tote.position, tote]));
    return Array.from({ length: this.state?.slots ?? 0 }, (_, i) => {
      const tote = by.get(i + 1), isLit = task?.tote === i + 1;
      const left = tote ? tote.pieces_left - piecesFor(tote.order_id, this.state, pending) : 0;
      const leaves = isLit ? null : this.leaving(i + 1, left ? tote.order_id : 0);
      return { position: i + 1, reference: tote?.reference ?? '', left, isLit, leaves };
    });
  }

  /** {reference, text} of an order whose tote is to be taken away, or null; `order` has pieces missing there. */
  leaving(position, order) {
    const change = this.changed.get(position);
    return change && change.until > Date.now() && change.order !== order ? change : null;
  }

  /** What can be taken back, or null. */
  get undoable() {
    const { last } = this;
    if (!last) return null;
    if (last.outcome !== PickOutcome.DONE) return Date.now() < last.until ? last : null;
    return last.unit === this.state?.shelf_id ? last : null;
  }

  // --- what the server sends

  /** Takes the stations in as they are now; returns what is worth a sound: 'arrives' or ''. */
  take(stations) {
    const now = stations.find(({ name }) => name === this.name) ?? null, before = this.state;
    this.stations = stations.map(({ name }) => name);
    const left = this.leftOf(before, now);
    this.state = now;
    this.shelf.write('told', now);
    const there = new Set((now?.picks ?? []).map(({ sequence }) => sequence));
    for (const sequence of this.settled.keys()) if (!there.has(sequence)) this.settled.delete(sequence);
    for (const row of left) this.flash(row);
    const came = now?.shelf_id && now.shelf_id !== before?.shelf_id && this.task;
    return came ? 'arrives' : '';
  }

  /** Totes whose orders are gone though pieces were missing: cancelled, or given to another station. */
  leftOf(before, now) {
    if (!before?.totes?.length || now?.mode !== StationMode.MANUAL) return [];
    const there = new Set(now.totes.map(({ order_id: id }) => id));
    const gone = before.totes.filter(({ order_id: id, pieces_left: left }) => left && !there.has(id));
    const { pending } = this;
    return gone.map(({ position, order_id: order, pieces_left: open, reference }) => {
      const isDone = piecesFor(order, before, pending) >= open;
      return { position, order, reference, text: isDone ? COMPLETE : tr`not ours any more: empty it` };
    });
  }

  flash({ position, ...change }) {
    this.changed.set(position, { ...change, until: Date.now() + FLASH });
  }

  // --- what a person does

  /** Takes a scanned code; returns {ok, text, sound}. */
  scan(code) {
    const { task } = this;
    if (!task) return no(tr`nothing is asked for now`);
    if (code === task.sku) return this.countOne(task);
    const meaning = meaningOf(code, this.name, this.stations);
    if (meaning.kind === 'tote') return this.intoTote(task, meaning.position);
    const expected = this.expected(task);
    if (meaning.kind === 'other tote') return no(tr`${code} is a tote of another station: ${expected}`);
    return no(tr`${code} is wrong: ${expected}`);
  }

  /** The next thing to scan, in words. */
  expected({ sku, quantity, tote }) {
    const { hand, placed } = this.counted;
    if (!hand || !tote) return tr`expected ${sku}`;
    return tr`expected tote ${tote}${hand + placed < quantity ? tr`, or ${sku} once more` : ''}`;
  }

  countOne({ sequence, sku, quantity, tote }) {
    const { hand, placed } = this.counted;
    if (hand + placed >= quantity) return no(tr`${quantity} × ${sku} are enough: expected tote ${tote}`);
    this.keep({ sequence, hand: hand + 1, placed });
    if (!tote && hand + placed + 1 === quantity) return this.confirm(quantity);
    const more = quantity - hand - placed - 1;
    return { ok: true, sound: 'counted', text: tr`${hand + placed + 1} of ${quantity} × ${sku}${tote ? tr`: into tote ${tote}` : more ? tr`, ${more} more` : ''}` };
  }

  intoTote({ sequence, sku, quantity, tote }, position) {
    const { hand, placed } = this.counted;
    if (!tote) return no(tr`no tote is needed here: expected ${sku}`);
    if (position !== tote) return no(tr`that is tote ${position}: expected tote ${tote}`);
    if (!hand) return no(tr`nothing is in your hand yet: expected ${sku}`);
    if (hand + placed === quantity) return this.confirm(quantity);
    this.keep({ sequence, hand: 0, placed: hand + placed });
    return { ok: true, sound: 'counted', text: tr`${hand + placed} of ${quantity} × ${sku} are in tote ${tote}` };
  }

  keep(count) {
    this.count = count;
    this.shelf.write('count', count);
  }

  /** Reports a number of pieces as taken, or put in. */
  confirm(quantity) {
    const { task } = this;
    const tote = this.totes.find(({ isLit }) => isLit);
    const isComplete = tote?.left === quantity;
    this.report(task, PickOutcome.DONE, quantity);
    if (isComplete) this.flash({ position: task.tote, order: task.order_id, reference: task.reference, text: COMPLETE });
    const where = task.tote ? tr`in tote ${task.tote}` : tr`put into ${task.item}`;
    const text = isComplete ? tr`${task.reference} is complete: take tote ${task.tote} away, set up a new one` : `${quantity} × ${task.sku} ${where}`;
    return { ok: true, sound: isComplete ? 'complete' : 'done', text };
  }

  /** Keeps the report of a task. Throws where this device can't keep it. */
  report(task, outcome, quantity) {
    const { sequence, sku, item, order_id: order, tote } = task, unit = this.state.shelf_id;
    const body = { order_id: order, item, quantity, outcome, id: newId() };
    this.last = { sequence, sku, item, tote, unit, quantity, outcome, until: Date.now() + WRITE_OFF_UNDO };
    this.shelf.write('last', this.last);
    this.keep({ sequence: 0, hand: 0, placed: 0 });
    this.outbox.add({ kind: 'report', sequence, body, what: `${quantity} × ${sku}` });
  }

  /** Takes the last report back; returns {ok, text, sound}. */
  undo() {
    const last = this.undoable;
    if (!last) return no(tr`nothing can be taken back now`);
    const what = last.outcome === PickOutcome.DONE ? `${last.quantity} × ${last.sku}` : last.sku;
    this.last = null;
    this.shelf.write('last', null);
    this.changed.delete(last.tote);
    if (!this.outbox.takeOut(last.sequence)) this.outbox.add({ kind: 'undo', sequence: last.sequence, what });
    return { ok: true, sound: 'done', text: tr`${what}: taken back${last.tote ? tr` out of tote ${last.tote}` : ''}` };
  }

  /** The server has answered an entry of the outbox. */
  answered({ kind, sequence, body }) {
    if (kind !== 'report') return;
    const isTold = this.state?.picks.some((pick) => pick.sequence === sequence);
    if (isTold) this.settled.set(sequence, body.outcome === PickOutcome.DONE ? body.quantity : 0);
  }
}

/** Pieces reported for an order that a station's state does not have yet. */
function piecesFor(order, { picks }, pending) {
  const reported = picks.filter(({ sequence, order_id: id }) => id === order && pending.has(sequence));
  return reported.reduce((sum, { sequence }) => sum + pending.get(sequence), 0);
}

function no(text) {
  return { ok: false, sound: 'refused', text };
}
