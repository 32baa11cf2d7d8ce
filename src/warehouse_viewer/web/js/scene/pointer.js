// SPDX-License-Identifier: Apache-2.0
// Mouse and fingers on the picture: select what is clicked, send the chosen robot to a cell.

import { on } from '../base/dom.js';
import { shownName } from '../base/words.js';

const STILL = { mouse: 6, touch: 14 }; // [px]; further, it was a drag
const FINGER = 22; // largest distance of a finger from a robot [px]

export class Pointer {
  /** `page` has choose(name, at), miss(at), details, world and take(cell, at), which may want the next cell. */
  constructor(page, picker, overlays) {
    Object.assign(this, { page, picker, overlays, hovered: null });
    const { canvas } = picker.stage;
    on(canvas, 'pointerdown', (event) => this.down(event));
    on(canvas, 'pointerup', (event) => this.up(event));
    on(canvas, 'pointermove', (event) => this.move(event));
    on(canvas, 'pointerleave', () => this.leave());
  }

  down(event) {
    this.from = event.isPrimary && event.button === 0 ? [event.clientX, event.clientY] : null;
  }

  up(event) {
    const at = [event.clientX, event.clientY];
    const isTouch = event.pointerType === 'touch';
    const still = this.from && Math.hypot(at[0] - this.from[0], at[1] - this.from[1])
      < STILL[isTouch ? 'touch' : 'mouse'];
    this.from = null;
    if (still) this.click(at, isTouch);
  }

  click(at, isTouch) {
    const meant = this.at(at);
    const { cell } = meant;
    const hit = meant.hit ?? (isTouch && !cell && this.picker.robotNear(...at, FINGER));
    if (hit) this.page.choose(this.page.world.nameOf(hit), at);
    else if (cell) this.page.take(cell, at);
    else this.page.miss(at);
  }

  /** What a click there means: {hit: {kind, index}} of a thing, {cell: [x, y]}, or neither.
   *
   *  While a cell is wanted, storage units do not hide the free cells behind them. */
  at(at) {
    const { world } = this.page;
    const solid = this.page.wantsCell && this.picker.pick(...at, ['robot', 'scenery']);
    if (solid) return { hit: solid };
    const cell = this.page.wantsCell ? this.cellAt(...at) : null;
    if (cell && world.unitAt(cell) < 0) return { cell };
    const hit = this.signAt(at) ?? this.picker.pick(...at);
    return hit ? { hit } : { cell };
  }

  /** The station whose sign is there, as {kind, index}; none while a cell is wanted, which a sign may hide. */
  signAt([x, y]) {
    if (this.page.wantsCell) return null;
    const sign = [...this.page.labels.box.querySelectorAll('.sign:not([hidden])')].find((element) => {
      const { left, right, top, bottom } = element.getBoundingClientRect();
      return x >= left && x <= right && y >= top && y <= bottom;
    });
    return (sign && this.page.world.indexOf.get(sign.textContent)) ?? null;
  }

  /** The grid point of the cell there, or null. */
  cellAt(x, y) {
    const point = this.picker.pointOnFloor(x, y);
    const { grid } = this.page.world.scene;
    return point && point.map((along) => Math.round(along / grid) * grid + 0);
  }

  move(event) {
    if (event.pointerType !== 'mouse' || event.buttons) return;
    const at = [event.clientX, event.clientY];
    const { hit, cell } = this.at(at);
    this.overlays.point(hit ? null : cell);
    this.picker.stage.canvas.style.cursor = hit || cell ? 'pointer' : '';
    this.hovered = hit ?? null;
    this.page.tip.hover(hit ? shownName(this.page.world.nameOf(hit)) : cell && this.page.textOf(cell), at);
  }

  leave() {
    this.hovered = null;
    this.overlays.point(null);
    this.page.tip.hover(null);
  }
}
