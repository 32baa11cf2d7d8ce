// SPDX-License-Identifier: Apache-2.0
// The time line at the bottom of the floor: the last hour of a running warehouse, or a recording.

import { $, on, press, setIcon } from '../base/dom.js';
import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';
import { clock, wallClock } from '../base/time.js';
import { ForecastFromHere } from './forecast.js';
import { freeze } from './frozen.js';
import { linkTo, lookOf, momentOf, timeOf, wallAt } from './link.js';
import { Player } from './player.js';
import { Recording } from './recording.js';
import { Track } from './track.js';

const REFRESH = 10_000; // of what there is, while a page is live [ms]
const FIRST = 2000; // for a server that has recorded nothing yet [ms]
const BEGINS_BACK = 30; // where playing begins if a live page is asked to play [s]
const PAST = tr`the time line shows the past: back to Live first`;
const RECORDED = tr`this is a recording`;
const RESTING = 0, WAITING = 3; // of Activity: from these on robots don't work

export class Timeline {
  /** `page` has takeScene, takeUpdate, takeEvents, takeFleet, log, bar, connection, world and tip. */
  constructor(page) {
    this.page = page;
    this.recording = new Recording();
    this.player = new Player(this.recording, this.shower(), {
      changed: () => this.draw(), failed: (error) => page.tip.say(error.message, 'refused') });
    this.track = new Track($('replay-track'), { seek: (time) => this.seek(time), textOf: (time) => this.textOf(time) });
    this.isLive = true;
    this.stamp = 0; // of the live warehouse [s]
    on($('replay-play'), 'click', () => this.toggle());
    on($('replay-speed'), 'change', () => { this.player.speed = Number($('replay-speed').value); });
    on($('replay-live'), 'click', () => this.goLive());
    on($('replay-copy'), 'click', () => this.copy());
    this.ahead = new ForecastFromHere(() => this.player.time);
    on(window, 'hashchange', () => this.follow());
    on(window, 'keydown', (event) => this.onKey(event));
    this.start();
  }

  /** What the player shows, on the page. */
  shower() {
    const { page } = this;
    return {
      scene: (scene) => page.takeScene(scene),
      reset: () => page.trails?.clear(),
      update: (update) => page.takeUpdate(update),
      past: (events) => page.log.replace(events),
      events: (events) => page.takeEvents(events),
      figures: (figures) => this.takeFigures(figures),
    };
  }

  async start() {
    const isNew = await this.recording.refresh().catch(() => false);
    if (!isNew) return;
    if (!this.recording.chunks.length) {
      setTimeout(() => this.start(), FIRST);
      return;
    }
    $('timeline').hidden = false;
    this.drawIndex();
    this.page.drawers?.fit();
    if (!this.recording.live) await this.begin();
    await this.follow();
    if (this.recording.live) setInterval(() => this.isLive && !document.hidden && this.refresh(), REFRESH);
  }

  /** A recording has nothing live to show. */
  async begin() {
    $('replay-live').hidden = true;
    $('replay-forecast').hidden = !this.recording.forecasts;
    const { about, cut } = this.recording;
    $('warehouse').textContent = about.name ?? tr`Recording`;
    document.title = tr`${about.name ?? tr`Recording`} – recording`;
    if (cut) this.page.tip.say(tr`the recording was cut off; it is played up to there`, 'refused');
    await this.enter(this.recording.begin);
  }

  async refresh() {
    if (await this.recording.refresh().catch(() => false)) this.drawIndex();
  }

  // --- a person
  /** Shows the moment that the address names, if it names one. */
  async follow() {
    const moment = momentOf(location.hash);
    if (!moment) return;
    await this.enter(timeOf(moment, this.recording.chunks));
    this.page.look(lookOf(location.hash));
  }

  seek(time) {
    if (this.isLive && time >= this.track.end) return;
    this.enter(time);
  }

  /** Shows the past from a time on [s]. */
  async enter(time) {
    this.target = time; // a later wish counts
    if (this.isLive) {
      this.isLive = false;
      this.page.connection.hold();
      this.freeze(this.recording.live ? PAST : RECORDED);
      this.fresh = this.recording.live && this.refresh();
    }
    await this.fresh;
    if (this.recording.live && time > this.recording.end) await this.refresh();
    if (this.target === time && !this.isLive) await this.player.seek(time);
  }

  async toggle() {
    if (this.player.isPlaying) return this.player.pause();
    if (this.isLive) await this.enter(this.recording.end - BEGINS_BACK);
    return this.player.play();
  }

  /** Space plays and pauses what is past, as it pauses the simulation else. */
  onKey({ key, target }) {
    const isOther = target.closest('button, input, select, textarea, dialog');
    if (key === ' ' && !this.isLive && !isOther) this.toggle();
  }

  goLive() {
    if (this.isLive) return;
    this.isLive = true;
    this.player.stop();
    this.freeze('');
    this.page.log.replace([]);
    $('replay-figures').replaceChildren();
    if (momentOf(location.hash)) history.replaceState(null, '', location.pathname + location.search);
    this.page.connection.release();
    this.draw();
  }

  freeze(reason) {
    document.body.classList.toggle('replaying', Boolean(reason));
    document.body.classList.toggle('recorded', reason === RECORDED);
    freeze(reason);
    const { bar } = this.page;
    if (reason) bar.link('paused', this.recording.live ? tr`past` : tr`recording`);
    bar.enable();
    $('factor').textContent = '';
  }

  async copy() {
    const link = linkTo(location.href, this.isLive ? this.stamp : this.player.time, this.page.looks());
    try {
      await navigator.clipboard.writeText(link);
      this.page.tip.say(tr`the link is copied`, 'done');
    } catch { // no permission, or no HTTPS: the address itself can be copied
      history.replaceState(null, '', link);
      this.page.tip.say(tr`the address above is the link`, 'done');
    }
  }

  // --- to the page
  /** Takes the time of the live warehouse [s]. */
  note(stamp) {
    if (!this.isLive) return;
    const isNews = Math.floor(stamp) !== Math.floor(this.stamp);
    this.stamp = stamp;
    if (isNews && !$('timeline').hidden) this.draw();
  }

  takeFigures({ kpis, fleet, stations }) {
    this.page.takeFleet(fleet ?? null, stations ?? []);
    this.kpis = kpis;
    this.drawFigures();
  }

  /** The moment that is shown, on the wall [s since 1970]; undefined: it is not known, or nothing was
   *  recorded of vehicles of VDA 5050. */
  get wall() {
    const { vda5050, chunks } = this.recording;
    return vda5050 ? wallAt(this.player.time, chunks) ?? undefined : undefined;
  }

  textOf(time) {
    const wall = wallAt(time, this.recording.chunks);
    return wall === null ? clock(time) : `${clock(time)} (${wallClock(wall)})`;
  }

  drawIndex() {
    this.setRange();
    this.track.setMarks(this.recording.marks);
    this.draw();
  }

  setRange() {
    this.track.setRange(this.recording.begin, Math.max(this.recording.end, this.isLive ? this.stamp : 0));
  }

  draw() {
    const { player, isLive } = this;
    const time = isLive ? this.stamp : player.time;
    if (isLive || this.track.end < this.recording.end) this.setRange();
    this.track.show(time);
    setIcon($('replay-play'), player.isPlaying ? 'pause' : 'play');
    $('replay-play').title = player.isPlaying ? tr`Pause the playback` : isLive ? tr`Play the last half minute` : tr`Play`;
    $('replay-play').setAttribute('aria-label', $('replay-play').title);
    press($('replay-live'), isLive);
    const { live, end } = this.recording;
    const text = live ? this.textOf(time) : tr`${this.textOf(time)} of ${clock(end)}`;
    if ($('replay-time').textContent !== text) $('replay-time').textContent = text;
    if (!isLive) this.drawFigures();
  }

  /** The figures of that moment: pieces an hour, orders done and late, robots at work. */
  drawFigures() {
    const { activity } = this.page.world;
    const working = activity.reduce((sum, does) => sum + (does > RESTING && does < WAITING), 0);
    const { kpis } = this;
    const rows = [...(kpis ? [[tr`pieces/h`, Math.round(kpis.item_throughput_per_hour)],
      [tr`orders done`, kpis.orders_completed], [tr`late`, kpis.orders_late]] : []),
    [tr`at work`, `${number(working)}/${number(activity.length)}`]];
    const text = rows.map(([name, value]) => `${typeof value === 'number' ? number(value) : value} ${name}`).join(' · ');
    if ($('replay-figures').textContent !== text) $('replay-figures').textContent = text;
  }
}
