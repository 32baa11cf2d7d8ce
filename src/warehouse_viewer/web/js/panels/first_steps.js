// SPDX-License-Identifier: Apache-2.0
// What the invitation does: a shift, a drive, a failure; and the tour that the first of them begins.

import { post } from '../base/api.js';
import { $ } from '../base/dom.js';
import { knownPerson } from '../base/person.js';
import { tr } from '../language/texts.js';
import { shownName } from '../base/words.js';

const FASTER = 10; // the first minute of a shift
const FAR = 8, NEAR = 2; // a first drive, in cells
const MANY = 40; // robots among which one is hard to see
const TOURED = 'toured'; // in localStorage, once the tour was closed

export class FirstSteps {
  /** `page` is the Page. */
  constructor(page) {
    this.page = page;
  }

  /** Does a step by its name; returns whether it was done. */
  async take(step) {
    try {
      await { shift: () => this.startShift(), drive: () => this.drive(), fail: () => this.break(), tour: () => this.tour() }[step]();
      if (step !== 'tour') this.tour(true);
      return true;
    } catch (error) {
      this.page.tip.say(error.message, 'refused');
      return false;
    }
  }

  /** Time that stands still goes on: nothing would move. */
  async resume() {
    if (this.page.bar.paused) await this.page.bar.act('resume');
  }

  async startShift() {
    this.page.tip.say(tr`a coordinator and orders are coming …`, 'sent');
    await this.resume();
    await post('/shift', { factor: FASTER, by: knownPerson() });
    this.page.tip.say(tr`orders come in; for a minute ${FASTER} times as fast`, 'done');
    this.page.showAll(false);
  }

  /** Sends a robot to a cell, and shows it. */
  async drive() {
    const { world, details } = this.page;
    const robots = this.robots((i) => !world.shelf[i] && !world.moving.has(i));
    if (!robots.length) throw new Error(tr`no robot is free now`);
    await this.resume();
    for (const i of robots) {
      const cell = this.wayOf(i);
      if (!cell) continue;
      const name = this.show(i);
      details.go(...cell);
      this.page.tip.say(tr`${name} drives to ${cell.join(', ')}: click any cell, and it goes there`, 'done');
      return;
    }
    throw new Error(tr`no robot has a free way now: select one and click a cell`);
  }

  /** A free cell that a robot reaches along x, then along y, past no robot; null: none. */
  wayOf(i) {
    const { world } = this.page, { grid } = world.scene, [x, y] = cellOf(world, i);
    const { bounds } = this;
    const taken = new Set(world.scene.robots.map((_, other) => String(cellOf(world, other))));
    taken.delete(String([x, y]));
    const isSeen = (cell) => world.unitAt(cell) < 0; // beneath a storage unit it would not be
    for (let far = FAR; far >= NEAR; --far) {
      for (const [dx, dy] of [[far, 0], [-far, 0], [0, far], [0, -far]]) {
        const [tx, ty] = [x + dx, y + dy];
        const isWithin = tx * grid > bounds[0] && tx * grid < bounds[1] && ty * grid > bounds[2] && ty * grid < bounds[3];
        const way = Array.from({ length: far }, (_, k) => String([x + Math.sign(dx) * (k + 1), y + Math.sign(dy) * (k + 1)]));
        if (isWithin && isSeen([tx * grid, ty * grid]) && !way.some((cell) => taken.has(cell))) return [tx * grid, ty * grid];
      }
    }
    return null;
  }

  /** The floor between what stands at its edges [x0, x1, y0, y1]. */
  get bounds() {
    const { world } = this.page, { floor } = world.scene;
    const places = world.scene.units.map((_, index) => world.placeOf({ kind: 'unit', index }));
    const within = (at, pick, edge) => (places.length ? pick(...places.map((place) => place[at])) : edge);
    return [within(0, Math.min, floor[0]) - 1, within(0, Math.max, floor[1]) + 1, within(1, Math.min, floor[2]) - 1, within(1, Math.max, floor[3]) + 1];
  }

  /** Breaks the drive of a robot that works, and shows it. */
  async break() {
    const { world } = this.page;
    const [i] = [...this.robots((k) => world.activity[k] === 1 && !world.failures[k]), ...this.robots((k) => !world.failures[k])];
    if (i === undefined) throw new Error(tr`every robot is broken already`);
    const id = world.scene.robots[i];
    await this.resume();
    await post(`/robots/${id}/failure`, { kind: 'MOTOR', by: knownPerson() });
    const name = this.show(i);
    this.page.tip.say(tr`the drive of ${shownName(name)} is broken: repair it, or see what becomes of the others`, 'done');
  }

  /** Selects a robot, and brings it near where there are many; returns its name. */
  show(i) {
    const { robots } = this.page.world.scene, name = `kiva${robots[i]}`;
    if (robots.length > MANY) this.page.find(name);
    else this.page.select(name);
    return name;
  }

  /** Indices of the robots that fit, those in the middle of the floor first. */
  robots(fits) {
    const { world } = this.page, [x0, x1, y0, y1] = world.scene.floor;
    const far = (i) => Math.hypot(world.pose[3 * i] - (x0 + x1) / 2, world.pose[3 * i + 1] - (y0 + y1) / 2);
    return world.scene.robots.map((_, i) => i).filter(fits).sort((a, b) => far(a) - far(b));
  }

  /** Shows what is where; `isFirst`: only to a person who has not closed it yet. */
  async tour(isFirst = false) {
    if (isFirst && localStorage.getItem(TOURED)) return;
    const { drawers } = this.page;
    if (drawers.isNarrow) drawers.close('start-panel'); // the tour is about what it covers
    const { Tour } = await import('./tour.js');
    this.shown ??= new Tour(() => localStorage.setItem(TOURED, 'yes'));
    if (!isFirst || !$('tour')?.checkVisibility()) this.shown.begin();
  }
}

/** The cell that a robot stands on. */
function cellOf({ pose, scene: { grid } }, i) {
  return [Math.round(pose[3 * i] / grid), Math.round(pose[3 * i + 1] / grid)];
}
