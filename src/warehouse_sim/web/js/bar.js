// SPDX-License-Identifier: Apache-2.0
// The bar at the top: which warehouse, its time, and what can be done to the simulation.

import { post } from './api.js';
import { $, setIcon } from './dom.js';

const STEP = 0.1, UNDO = 5; // [s], simulated
const CHECKPOINT = 'viewer'; // the name of the page's own
// The action each control needs; what the engine lacks is disabled, with the reason.
const NEEDS = { pause: 'pause', step: 'step', speed: 'speed', checkpoint: 'checkpoint',
  restore: 'restore', undo: 'undo', reset: 'reset' };

export class Bar {
  /** `say(text, kind)` tells the person at the page. */
  constructor(say) {
    this.say = say;
    this.titles = Object.fromEntries(Object.keys(NEEDS).map((id) => [id, $(id).title]));
    this.paused = false;
    this.live = false;
    this.stepSize = 0.001; // [s]
    this.lacks = {};
    const act = (path, body, done) => () => this.act(path, body, done);
    $('pause').onclick = () => this.act(this.paused ? 'resume' : 'pause');
    $('step').onclick = () => this.step();
    $('undo').onclick = act('undo', { seconds: UNDO }, `${UNDO} s undone`);
    $('reset').onclick = act('reset', { time_too: true }, 'everything is back at its start');
    $('checkpoint').onclick = act('checkpoint', { name: CHECKPOINT }, 'checkpoint kept');
    $('restore').onclick = act('restore', { name: CHECKPOINT }, 'back at the checkpoint');
    $('speed').onchange = () => this.act('speed', { factor: Number($('speed').value) });
  }

  /** Time that runs is paused first. */
  step() {
    if (!this.paused) return this.act('pause');
    return this.act('step', { steps: Math.max(1, Math.round(STEP / this.stepSize)) });
  }

  async act(path, body, done) {
    try {
      await post(`/simulation/${path}`, body);
      if (path === 'pause' || path === 'resume') this.showPaused(path === 'pause');
      if (done) this.say(done, 'done');
    } catch (error) {
      this.say(error.message, 'refused');
    }
  }

  showTime(stamp) {
    const [minutes, seconds] = [Math.floor(stamp / 60), stamp % 60];
    $('time').textContent = `${minutes}:${seconds.toFixed(1).padStart(4, '0')}`;
  }

  showLink(live) {
    this.live = live;
    this.link(live ? 'live' : 'away', live ? 'live' : 'no connection; trying again');
    this.enable();
  }

  link(state, text) {
    $('link').dataset.state = state;
    $('link').textContent = text;
  }

  showStatus(status) {
    this.lacks = status.lacks;
    if (status.away) {
      this.link('away', 'the simulation is away');
      this.enable();
      return;
    }
    $('warehouse').textContent = status.warehouse || 'Warehouse';
    this.link(status.paused ? 'paused' : 'live', status.paused ? 'paused' : 'live');
    $('factor').textContent = status.paused ? '' : `×${status.factor.toFixed(2)}`;
    this.stepSize = status.step_size;
    this.showPaused(status.paused);
    this.showSpeed(status.target_factor);
    this.enable();
  }

  showPaused(paused) {
    this.paused = paused;
    setIcon($('pause'), paused ? 'play' : 'pause');
  }

  showSpeed(factor) {
    const select = $('speed');
    if (document.activeElement === select) return;
    const value = String(Math.round(factor * 100) / 100);
    if (![...select.options].some((option) => option.value === value)) {
      select.add(new Option(`${value}×`, value));
    }
    select.value = value;
  }

  enable() {
    for (const [id, action] of Object.entries(NEEDS)) {
      const lack = this.live ? this.lacks[action] : 'no connection';
      $(id).disabled = Boolean(lack);
      const title = lack ? `${this.titles[id]} – not now: ${lack}` : this.titles[id];
      (id === 'speed' ? $(id).parentElement : $(id)).title = title;
    }
  }
}
