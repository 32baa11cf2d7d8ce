// SPDX-License-Identifier: Apache-2.0
// How often the picture is drawn. A graphics card draws whenever the display shows something; a
// processor that draws leaves most of its time to the simulation.

export const SHARE = 1 / 6; // of the time, in which pictures are drawn, at least
export const MOST = 2 / 3; // the same where the simulation keeps its speed all the same
export const CROWD = 2000; // robots from which SHARE is the limit, or the page would take a core
export const HURRIED = 1 / 2; // the same while the camera is moved, at least
const KEPT = 0.97; // of the speed that is wanted: it is kept
const MORE = 1.25, LESS = 0.5; // factors of the share at each look at the speed
const ADAPT = 1000; // between two looks at the speed [ms]
const HURRY = 500; // after it was [ms]
const SLOWEST = 500; // from one picture to the next [ms]
const NEW = 0.3; // weight of the last picture's cost beside those before
const LOOK = 4; // between two looks at whether a picture is done [ms]
export const DISPLAY = 16; // from one picture of the display to the next [ms]

export class Pace {
  /** `onPicture(gap)` gets the time from one picture to the next [ms], after each. */
  constructor(onPicture, clock = () => performance.now(), later = (done, ms) => setTimeout(done, ms)) {
    Object.assign(this, { onPicture, clock, later });
    this.share = SHARE;
    this.keepsSpeed = false; // the simulation
    this.most = MOST; // of the time, in which pictures are drawn
    this.adapted = clock(); // [ms]
    this.cost = 0; // of a picture [ms]
    this.gap = 0; // from one picture to the next, at least [ms]
    this.hurriedUntil = 0; // [ms]
    this.rest = Promise.resolve(); // until the next picture may be drawn
  }

  /** The camera is moved: who does so waits for the picture. */
  hurry() {
    this.hurriedUntil = this.clock() + HURRY;
  }

  /** The simulation has a speed, and a wanted one (0: as fast as it can): where it falls behind, the
   *  processor is left to it. */
  yieldTo(factor, least) {
    this.keepsSpeed = least > 0 && factor >= KEPT * least;
  }

  /** Takes the count of robots that are drawn. */
  expect(robots) {
    this.most = robots < CROWD ? MOST : SHARE;
  }

  /** Moves the share towards its limit; to be called often, for speeds come only when they change. */
  adapt() {
    if (this.clock() < this.adapted + ADAPT) return;
    this.adapted = this.clock();
    this.share = Math.max(SHARE, Math.min(this.most, this.share * (this.keepsSpeed ? MORE : LESS)));
  }

  /** A picture was begun then [ms]; `isDone()`: whether the processor has drawn it. */
  drew(begun, isDone) {
    this.rest = this.finish(begun, isDone);
  }

  async finish(begun, isDone) {
    while (!isDone()) await this.wait(LOOK);
    const cost = this.clock() - begun;
    this.cost += (this.cost ? NEW : 1) * (cost - this.cost);
    this.adapt();
    const share = this.clock() < this.hurriedUntil ? Math.max(HURRIED, this.share) : this.share;
    this.gap = Math.min(SLOWEST, this.cost / share);
    this.onPicture(this.gap);
    // It begins with a picture of the display: the nearest, not the next.
    await this.wait(begun + this.gap - DISPLAY / 2 - this.clock());
  }

  wait(ms) {
    return new Promise((done) => this.later(done, Math.max(0, ms)));
  }
}
