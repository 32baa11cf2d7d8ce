// SPDX-License-Identifier: Apache-2.0
// Plays a Recording: a clock that runs at a speed, and what there was to be seen when it shows that.

import { tr } from '../language/texts.js';
import { State } from './state.js';

const TICK = 100; // between two pictures [ms]
const AHEAD = 0.9; // of a chunk, after which the next one is fetched
const FRESH = 2000; // between two looks for what a running warehouse has recorded since [ms]

export class Player {
  /** `show` gets what was: {scene(scene), reset(), update(update), past(events), events(events), figures(figures)};
   *  `changed()` is called when time, speed or state have; `failed(error)` if a chunk can't be had. */
  constructor(recording, show, { changed, failed, now = () => performance.now() }) {
    Object.assign(this, { recording, show, changed, failed, now });
    this.state = new State();
    Object.assign(this, { time: 0, speed: 1, isPlaying: false, chunk: null, shown: null, busy: null, target: null, looked: -Infinity });
  }

  /** Shows a moment [s]. Of many wishes that come while one is carried out the last counts. */
  async seek(time) {
    const { begin, end } = this.recording;
    this.time = this.target = Math.min(end, Math.max(begin, time));
    this.changed();
    this.busy ??= this.seekAll().finally(() => { this.busy = null; });
    return this.busy;
  }

  async seekAll() {
    while (this.target !== null) {
      const time = this.target;
      this.target = null;
      await this.guarded(() => this.openAt(time, true));
    }
  }

  play() {
    if (this.time >= this.recording.end - 0.05 && !this.recording.live) this.seek(this.recording.begin);
    this.isPlaying = true;
    this.last = this.now();
    clearInterval(this.timer);
    this.timer = setInterval(() => this.tick(), TICK);
    this.changed();
  }

  pause() {
    this.isPlaying = false;
    clearInterval(this.timer);
    this.changed();
  }

  /** What is played next no longer is: another page's content is shown. */
  stop() {
    this.pause();
    Object.assign(this, { chunk: null, shown: null, target: null });
  }

  async tick() {
    const now = this.now(), passed = (now - this.last) / 1000;
    this.last = now;
    if (this.busy || !this.chunk) return;
    this.busy = this.guarded(() => this.goOn(this.time + this.speed * passed));
    await this.busy;
    this.busy = null;
    if (this.target !== null) this.seek(this.target);
  }

  async guarded(act) {
    try {
      await act();
    } catch (error) {
      this.pause();
      this.failed(error);
    }
  }

  async goOn(time) {
    const { recording } = this;
    await this.look(time);
    this.time = Math.min(recording.end, time);
    const chunk = recording.chunkAt(this.time);
    if (chunk.number === this.chunk.number) await this.advance();
    else await this.openAt(this.time, false);
    if (time >= recording.end && !recording.live) this.pause();
    this.changed();
  }

  /** Looks near its end for what a running warehouse has recorded since. */
  async look(time) {
    const { recording } = this;
    if (!recording.live || time < recording.end - 1 || this.now() - this.looked < FRESH) return;
    this.looked = this.now();
    await recording.refresh();
    const { number } = this.chunk;
    if (recording.chunks.some((chunk) => chunk.number === number)) await this.continueAt(number);
  }

  /** Takes what has come to the chunk that is played since. */
  async continueAt(number) {
    const chunk = this.recording.chunks.find((other) => other.number === number);
    this.content = await this.recording.load(chunk);
    this.chunk = chunk;
  }

  /** Shows a moment from its chunk's begin; `isJump`: it is not the one after what was shown. */
  async openAt(time, isJump) {
    const chunk = this.recording.chunkAt(time);
    if (!chunk) throw new Error(tr`nothing is recorded yet`);
    const [content, scene] = await Promise.all([this.recording.load(chunk), this.recording.scene(chunk.scene)]);
    if (this.shown !== scene) this.show.scene(scene);
    Object.assign(this, { chunk, content, shown: scene, update: 0, text: 0 });
    this.state.setScene(scene);
    if (isJump) this.show.reset();
    await this.advance(isJump);
    this.changed();
  }

  /** Shows what was up to the present time. */
  async advance(isJump = false) {
    const { updates, texts } = this.content;
    while (updates[this.update]?.stamp <= this.time + 1e-6) this.state.take(updates[this.update++]);
    const due = [];
    while (texts[this.text]?.stamp <= this.time + 1e-6) due.push(texts[this.text++].message);
    this.emit(due, isJump);
    const next = updates[this.update] ?? await this.following();
    this.show.update({ ...this.state.at(this.time, next), revision: this.shown.revision });
  }

  emit(messages, isJump) {
    const past = isJump && messages.find(({ type }) => type === 'past');
    const events = messages.filter(({ type }) => type === 'events').flatMap((message) => message.events);
    if (past) this.show.past([...past.events, ...events]);
    else if (events.length) this.show.events(events);
    const figures = messages.findLast(({ type }) => type === 'figures');
    if (figures) this.show.figures(figures);
  }

  /** The first update of the next chunk, once it is worth fetching. */
  async following() {
    const { begin, end } = this.chunk;
    const next = this.recording.after(this.chunk);
    if (!next || next.scene !== this.chunk.scene || this.time < begin + AHEAD * (end - begin)) return null;
    return (await this.recording.load(next)).updates[0];
  }
}
