// SPDX-License-Identifier: Apache-2.0
// The screen of a person at a station, for a scanner, fingers in gloves, or a keyboard.

import { get, put } from '../base/api.js';
import { $, on, press } from '../base/dom.js';
import { PickOutcome, StationMode } from '../base/message_enums.js';
import { confirmed } from '../base/question.js';
import { ownPath } from '../base/root.js';
import { tr } from '../language/texts.js';
import { stayAwake } from './awake.js';
import { Bench } from './bench.js';
import { meaningOf } from './codes.js';
import { News } from './news.js';
import { Outbox } from './outbox.js';
import { Scanner } from './scanner.js';
import { senderOf } from './send.js';
import { Settings } from './settings.js';
import { Shelf } from './shelf.js';
import { Sounds } from './sounds.js';
import { View } from './view.js';

const TICK = 1000; // between two looks at what goes by the clock [ms]

class Page {
  constructor(name) {
    this.name = name;
    const shelf = new Shelf(`station/${name}/`);
    this.outbox = new Outbox(`station/${name}/out/`, localStorage, senderOf(name), {
      changed: () => this.view?.show(),
      answered: (entry) => this.bench.answered(entry),
      refused: (entry, reason) => this.refused(entry, reason),
    });
    this.bench = new Bench(name, shelf, this.outbox);
    this.view = new View(this.bench);
    this.sounds = new Sounds(new Shelf('station/'));
    this.scanner = new Scanner((code) => this.scan(code));
    this.settings = new Settings(name, this.scanner, (code) => this.scan(code));
    this.scanner.listen(document);
    this.bindButtons();
    this.news = new News({ take: (stations) => this.take(stations), link: (state) => this.link(state) });
    this.view.show();
    this.outbox.run();
    setInterval(() => this.view.show(), TICK);
  }

  bindButtons() {
    on($('confirm'), 'click', () => this.confirm());
    on($('fewer'), 'click', () => this.view.step(-1));
    on($('more'), 'click', () => this.view.step(1));
    on($('undo'), 'click', () => this.undo());
    on($('short'), 'click', () => this.writeOff(PickOutcome.SHORT));
    on($('damaged'), 'click', () => this.writeOff(PickOutcome.DAMAGED));
    on($('by-hand'), 'click', () => this.switchMode());
    on($('sound'), 'click', () => this.mute(!this.sounds.isMuted));
    press($('sound'), !this.sounds.isMuted);
  }

  // --- what comes from the server

  take(stations) {
    const sound = this.bench.take(stations);
    if (sound) this.show({ ok: true, sound, text: tr`unit ${this.bench.state.shelf_id} is here` });
    this.view.show();
  }

  link(state) {
    this.view.showLink(state);
    if (state !== 'away') this.outbox.hurry();
    this.view.show();
  }

  /** What was kept here can't be booked: a person must know, in plain words. */
  refused({ what, kind }, reason) {
    const text = kind === 'undo' ? tr`${what} is not taken back: ${reason}` : tr`${what} is not booked: ${reason}`;
    this.show({ ok: false, sound: 'refused', text });
  }

  show(result) {
    this.sounds.play(result.sound);
    this.view.say(result);
  }

  // --- what a person does

  scan(code) {
    if ($('question').open) return this.answer(code);
    const { kind, name } = meaningOf(code, this.name, this.bench.stations);
    if (kind !== 'command' || code === this.bench.task?.sku) return this.do(() => this.bench.scan(code));
    const [short, damaged] = [PickOutcome.SHORT, PickOutcome.DAMAGED];
    const acts = { ALL: () => this.confirm(true), UNDO: () => this.undo(), SHORT: () => this.writeOff(short), DAMAGED: () => this.writeOff(damaged) };
    if (acts[name]) return acts[name]();
    return this.show({ ok: false, sound: 'refused', text: tr`there is no question now that yes or no could answer` });
  }

  /** A scanned YES or NO answers the question that is open. */
  answer(code) {
    const { name } = meaningOf(code, this.name, this.bench.stations);
    if (name === 'YES' || name === 'NO') $(name === 'YES' ? 'question-yes' : 'question-no').click();
    else this.show({ ok: false, sound: 'refused', text: tr`${code}: answer the question first` });
  }

  /** Shows the result of act(), or why this device could not keep it. */
  do(act) {
    try {
      this.show(act());
    } catch (error) {
      this.show({ ok: false, sound: 'refused', text: tr`this device can't keep it: ${error.message}` });
    }
    this.view.show();
  }

  confirm(isScanned = false) {
    const { task } = this.bench;
    if (!task || !(isScanned || this.view.isSettled)) return;
    this.do(() => this.bench.confirm(isScanned ? task.quantity : this.view.pieces));
  }

  undo() {
    this.do(() => this.bench.undo());
  }

  /** Asks before something is written off; at a picking station SHORT is for the whole bin. */
  async writeOff(outcome) {
    const { bench } = this, { task } = bench;
    if (!task) return;
    const isEmpty = outcome === PickOutcome.SHORT && bench.isPicking, pieces = this.view.pieces;
    const booked = isEmpty ? await inBin(task).catch(() => null) : pieces;
    const what = `${booked ?? tr`all`} × ${task.sku}`, verb = bench.isPicking ? tr`Write off` : tr`Leave out`;
    const why = outcome === PickOutcome.DAMAGED ? tr`Damaged` : isEmpty ? tr`Bin ${task.item} is empty` : tr`Not there`;
    if (!await confirmed(`${why}?`, tr`${verb} ${what}, in bin ${task.item}.`, `${verb} ${what}`, tr`Back`)) return;
    if (bench.task?.sequence !== task.sequence) return this.show({ ok: false, sound: 'refused', text: tr`${task.sku} is no longer asked for` });
    this.do(() => {
      bench.report(task, outcome, isEmpty ? 0 : pieces);
      return { ok: true, sound: 'done', text: tr`${what} in ${task.item}: written off` };
    });
  }

  async switchMode() {
    const { state } = this.bench;
    const mode = state.mode === StationMode.MANUAL ? StationMode.AUTOMATIC : StationMode.MANUAL;
    try {
      await put(`/stations/${encodeURIComponent(this.name)}`, { open: state.open, mode });
      this.view.say({ ok: true, text: '' });
    } catch (error) {
      this.show({ ok: false, sound: 'refused', text: error.message });
    }
  }

  mute(isMuted) {
    this.sounds.mute(isMuted);
    press($('sound'), !isMuted);
  }
}

/** Pieces in a task's bin, by the books. */
async function inBin({ sku, item }) {
  const { places } = await get(`/stock?limit=1000&sku=${encodeURIComponent(sku)}`);
  return places.find((place) => place.item === item)?.quantity ?? null;
}

stayAwake();
window.page = new Page(decodeURIComponent(ownPath().split('/')[2])); // for a look from the console
