// SPDX-License-Identifier: Apache-2.0
// Mouse and fingers on the picture: select what is clicked, send the chosen robot to a cell.

const STILL = 6; // [px]; further, it was a drag

export class Pointer {
  /** `page` has select(name), details and world. */
  constructor(page, picker, overlays) {
    Object.assign(this, { page, picker, overlays });
    const { canvas } = picker.stage;
    canvas.addEventListener('pointerdown', (event) => this.down(event));
    canvas.addEventListener('pointerup', (event) => this.up(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerleave', () => this.leave());
  }

  down(event) {
    this.from = event.isPrimary && event.button === 0 ? [event.clientX, event.clientY] : null;
  }

  up(event) {
    const [x, y] = [event.clientX, event.clientY];
    const still = this.from && Math.hypot(x - this.from[0], y - this.from[1]) < STILL;
    this.from = null;
    if (still) this.click(x, y);
  }

  click(x, y) {
    const hit = this.picker.pick(x, y);
    const cell = hit ? null : this.cellAt(x, y);
    if (hit) this.page.select(this.page.world.nameOf(hit));
    else if (cell && this.page.details.selectedRobot >= 0) this.page.details.go(...cell, [x, y]);
    else this.page.select(null);
  }

  /** The grid point of the cell there, or null. */
  cellAt(x, y) {
    const point = this.picker.pointOnFloor(x, y);
    const { grid } = this.page.world.scene;
    return point && point.map((at) => Math.round(at / grid) * grid + 0);
  }

  move(event) {
    if (event.pointerType !== 'mouse' || event.buttons) return;
    const [x, y] = [event.clientX, event.clientY];
    const hit = this.picker.pick(x, y);
    const chosen = this.page.details.selectedRobot >= 0;
    const cell = hit || !chosen ? null : this.cellAt(x, y);
    this.overlays.point(cell);
    this.picker.stage.canvas.style.cursor = hit || cell ? 'pointer' : '';
    this.page.tip.hover(hit ? this.page.world.nameOf(hit) : cell && `go to ${cell.join(', ')}`, [x, y]);
  }

  leave() {
    this.overlays.point(null);
    this.page.tip.hover(null);
  }
}
