// SPDX-License-Identifier: Apache-2.0
// The recorded shift of the first view, seen from above, again and again.

import { $, on, press } from '../base/dom.js';
import { send } from '../base/request.js';
import { tr } from '../language/texts.js';
import { World } from '../base/world.js';
import { Player } from '../replay/player.js';
import { Recording } from '../replay/recording.js';
import { paint } from './picture.js';

const ROOT = '/recordings/at_work';
const SPEED = 3; // of the clock
const nothing = () => {};
const BUSY = [1, 2]; // activities of a robot that has work

export class Example {
  constructor() {
    this.world = new World();
    const show = {
      scene: (scene) => this.world.setScene(scene), update: (update) => this.take(update),
      reset: nothing, past: nothing, events: nothing, figures: nothing,
    };
    this.recording = new Recording((path) => send('GET', `${ROOT}${path}`));
    this.player = new Player(this.recording, show, { changed: nothing, failed: () => this.end() });
    this.player.speed = SPEED;
    this.isWanted = this.isReady = false;
    // A person who wants no motion starts it by the button.
    this.isOn = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    on($('example-play'), 'click', () => this.toggle());
    on(document, 'visibilitychange', () => this.run());
    this.begin();
  }

  async begin() {
    const isThere = await this.recording.refresh().catch(() => false);
    if (!isThere || !this.recording.chunks.length) return;
    await this.player.seek(this.recording.begin);
    this.isReady = true;
    this.run();
  }

  /** Shows it, or stops it while a warehouse runs. */
  show(isWanted) {
    if (isWanted === this.isWanted) return;
    this.isWanted = isWanted;
    this.run();
  }

  toggle() {
    this.isOn = !this.isOn;
    this.run();
  }

  run() {
    $('example').hidden = !this.isReady;
    press($('example-play'), this.isOn);
    $('example-play').textContent = this.isOn ? tr`Pause` : tr`Play`;
    const plays = this.isReady && this.isWanted && this.isOn && !document.hidden;
    if (plays && !this.player.isPlaying) this.player.play();
    else if (!plays) this.player.pause();
    this.draw();
  }

  take(update) {
    const now = performance.now();
    this.world.apply(update, now);
    this.world.shown.set(this.world.pose); // the player has them on their way
    this.draw();
    if (update.stamp >= this.recording.end - 0.2) this.player.seek(this.recording.begin);
  }

  draw() {
    if (!this.isReady || !this.isWanted) return;
    const { world } = this;
    const robots = world.scene.robots.map((_, index) => ({ ...at(world, 'robot', index), isBusy: BUSY.includes(world.activity[index]) }));
    paint($('example-floor'), { robots, units: world.scene.units.map((_, index) => at(world, 'unit', index)) });
  }

  end() {
    this.isReady = false;
    $('example').hidden = true;
  }
}

function at(world, kind, index) {
  const [x, y] = world.placeOf({ kind, index });
  return { x, y };
}
