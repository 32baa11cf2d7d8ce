// SPDX-License-Identifier: Apache-2.0
// The bar at the top: which warehouse, its time, and what can be done to the simulation.

import { post } from '../base/api.js';
import { $, enable, on, setIcon, setText } from '../base/dom.js';
import { number } from '../language/numbers.js';
import { confirmed } from '../base/question.js';
import { tr } from '../language/texts.js';
import { clock } from '../base/time.js';
import { Clicks } from './clicks.js';

const STEP = 0.1, UNDO = 5; // [s], simulated
const SAVED_EVERY = 1; // [s], simulated: what undo goes back to
const CHECKPOINT = 'viewer', BEFORE_RESET = 'before-reset'; // names of the page's own
// The action each control needs; what the engine lacks is disabled, with the reason.
const NEEDS = { pause: 'pause', step: 'step', speed: 'speed', checkpoint: 'checkpoint',
  restore: 'restore', undo: 'undo', reset: 'reset' };

export class Bar {
  /** `say(text, kind)` shows the person at the page a text; `offer(text, label, act)` adds a button. */
  constructor(say, offer) {
    Object.assign(this, { say, offer, stopped: null, paused: false, live: false, lacks: {} });
    this.stepSize = 0.001; // [s]
    this.latest = 0; // simulated time that was reached [s]
    this.clicks = new Clicks(() => this.live && this.showStatus(this.status));
    on($('pause'), 'click', () => this.act(this.paused ? 'resume' : 'pause'));
    on($('step'), 'click', () => this.step());
    on($('undo'), 'click', () => this.act('undo', { seconds: UNDO }, tr`${UNDO} s undone`));
    on($('reset'), 'click', () => this.reset());
    on($('checkpoint'), 'click', () => this.keep());
    on($('restore'), 'click', () => this.act('restore', { name: CHECKPOINT }, tr`checkpoint restored`));
    on($('stop-all'), 'click', () => this.stopAll());
    on($('speed'), 'change', () => this.act('speed', { factor: Number($('speed').value) }));
  }

  /** Time that runs is paused first. */
  step() {
    if (!this.paused) return this.act('pause');
    return this.act('step', { steps: Math.max(1, Math.round(STEP / this.stepSize)) });
  }

  async keep() {
    if (!await this.act('checkpoint', { name: CHECKPOINT }, tr`checkpoint saved`)) return;
    sessionStorage.setItem('checkpoint', 'kept');
    this.enable();
  }

  /** Asks first, and can be undone where checkpoints can be taken. */
  async reset() {
    const lack = this.lacks.checkpoint;
    const undone = lack ? tr`This can't be undone: ${lack}.` : tr`It can be undone.`;
    const text = tr`Robots, storage units and items go back to where they started, and the time to 0:00:00. `
      + tr`Running commands are cancelled; commands sent while the simulation is paused are carried out afterwards. ${undone}`;
    if (!await confirmed(tr`Reset the warehouse?`, text, tr`Reset`)) return;
    const kept = !lack && await this.act('checkpoint', { name: BEFORE_RESET });
    if (!lack && !kept) return;
    if (!await this.act('reset', { time_too: true })) return;
    const done = tr`everything is back at its start`;
    if (!kept) this.say(done, 'done');
    else this.offer(done, tr`Undo`, () => this.act('restore', { name: BEFORE_RESET }, tr`the reset is undone`));
  }

  /** Stops all robots without a question; lets them go on after one. */
  async stopAll() {
    const isHeld = this.stopped !== null;
    if (isHeld && !await confirmed(tr`Release the emergency stop?`, tr`All robots go on with what they did.`, tr`Release`)) return;
    const by = localStorage.getItem('person') ?? '';
    const click = this.clicks.begin('held');
    try {
      const { message } = await post(`/fleet/${isHeld ? 'release' : 'stop'}`, { by });
      if (this.clicks.note('held', click, !isHeld)) {
        this.showStopped(isHeld ? null : by || tr`you`);
        this.tellState();
      }
      this.say(message, 'done');
    } catch (error) {
      this.say(error.message, 'refused');
    }
  }

  /** By whom the fleet is stopped; null: it may move. */
  showStopped(by) {
    if (by === this.stopped) return;
    this.stopped = by;
    $('stop-all').textContent = by === null ? tr`Stop all` : tr`Release`;
    $('stop-all').classList.toggle('is-held', by !== null);
  }

  /** True if it was done. */
  async act(path, body, done) {
    const pauses = { pause: true, resume: false }[path];
    const click = pauses === undefined ? null : this.clicks.begin('paused');
    try {
      await post(`/simulation/${path}`, body);
      if (click && this.clicks.note('paused', click, pauses)) {
        this.showPaused(pauses);
        this.tellState();
      }
      if (done) this.say(done, 'done');
      return true;
    } catch (error) {
      this.say(error.message, 'refused');
      return false;
    }
  }

  showTime(stamp) {
    const reached = this.latest >= UNDO + SAVED_EVERY;
    this.latest = Math.max(this.latest, stamp);
    if (!reached && this.latest >= UNDO + SAVED_EVERY) this.enable();
    setText($('time'), clock(stamp, true));
  }

  showLink(live, reason) {
    this.live = false; // until its state is known
    this.link('away', live ? tr`loading …` : tr`${reason}; trying again`);
    this.enable();
  }

  link(state, text) {
    $('link').dataset.state = state;
    setText($('link'), text);
  }

  /** Says beside the name what time and the fleet do. */
  tellState() {
    const held = this.stopped === null ? '' : tr`emergency stop by ${this.stopped}`;
    this.link(held ? 'away' : this.paused ? 'paused' : 'live', held || (this.paused ? tr`paused` : tr`live`));
  }

  showStatus(status) {
    this.status = status; // the newest one
    this.lacks = status.lacks;
    this.live = true;
    if (status.away) {
      this.link('away', tr`the simulation does not answer`);
      this.enable();
      return;
    }
    setText($('warehouse'), status.warehouse || tr`Warehouse`);
    const stopped = status.stopped ?? null;
    if (!this.clicks.mayPrecede('held', stopped !== null)) this.showStopped(stopped);
    if (!this.clicks.mayPrecede('paused', status.paused)) this.showPaused(status.paused);
    $('stop-all').hidden = Boolean(this.lacks.stop);
    this.tellState();
    setText($('factor'), this.paused ? '' : `×${number(status.factor, 2)}`);
    this.stepSize = status.step_size;
    this.showSpeed(status.target_factor);
    this.enable();
  }

  showPaused(paused) {
    if (paused === this.paused) return;
    this.paused = paused;
    setIcon($('pause'), paused ? 'play' : 'pause');
    $('pause').querySelector('span').textContent = paused ? tr`Resume` : tr`Pause`;
  }

  showSpeed(factor) {
    const select = $('speed');
    if (document.activeElement === select) return;
    const value = String(Math.round(factor * 100) / 100);
    if (![...select.options].some((option) => option.value === value)) {
      select.add(new Option(`${number(value, 0, 2)}×`, value));
    }
    select.value = value;
  }

  enable() {
    const early = {
      restore: !sessionStorage.getItem('checkpoint') && tr`no checkpoint was saved on this page`,
      undo: this.latest < UNDO + SAVED_EVERY && tr`less than ${UNDO} s have passed`,
    };
    for (const [id, action] of Object.entries(NEEDS)) {
      const lack = this.live ? this.lacks[action] || early[id] : $('link').textContent;
      enable($(id), lack, id === 'speed' ? $(id).parentElement : $(id));
    }
  }
}
