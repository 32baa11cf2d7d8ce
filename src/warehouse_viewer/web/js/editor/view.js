// SPDX-License-Identifier: Apache-2.0
// Where on the canvas a cell is: zoom and pan.

const LEAST = 2, MOST = 96; // [px] a cell
export const RULER = 24; // [px] along the upper and the left edge

export class View {
  constructor() {
    Object.assign(this, { scale: 24, x: RULER, y: 0, width: 0, height: 0 });
    // x, y: the lower left corner of cell [0, 0] on the canvas [px].
  }

  resize(width, height) {
    this.y += height - this.height; // the lower edge stays
    Object.assign(this, { width, height });
  }

  /** The cell beneath a point of the canvas [px]. */
  cellAt(px, py) {
    return [Math.floor((px - this.x) / this.scale), Math.floor((this.y - py) / this.scale)];
  }

  /** {x, y, width, height} of a rectangle of cells on the canvas [px]. */
  boxOf({ left, bottom, right, top }) {
    const { scale } = this;
    return { x: this.x + left * scale, y: this.y - top * scale, width: (right - left) * scale, height: (top - bottom) * scale };
  }

  centreOf([column, row]) {
    return [this.x + (column + 0.5) * this.scale, this.y - (row + 0.5) * this.scale];
  }

  /** The cells in sight, as a rectangle. */
  get seen() {
    const [left, top] = this.cellAt(0, 0), [right, bottom] = this.cellAt(this.width, this.height);
    return { left, bottom, right: right + 1, top: top + 1 };
  }

  pan(dx, dy) {
    this.x += dx;
    this.y += dy;
  }

  /** Nearer or farther, about a point of the canvas that stays where it is [px]. */
  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const scale = Math.min(MOST, Math.max(LEAST, this.scale * factor)), by = scale / this.scale;
    this.x = px - (px - this.x) * by;
    this.y = py - (py - this.y) * by;
    this.scale = scale;
  }

  /** Shows a rectangle of cells, as large as it goes up to a scale [px a cell]. */
  show({ left, bottom, right, top }, most = 40) {
    const room = [this.width - RULER, this.height - RULER];
    const fit = Math.min((room[0] * 0.94) / (right - left), (room[1] * 0.92) / (top - bottom), most);
    this.scale = Math.max(LEAST, fit >= 8 ? Math.floor(fit) : fit);
    this.x = Math.round(RULER + room[0] / 2 - ((left + right) / 2) * this.scale);
    this.y = Math.round(RULER + room[1] / 2 + ((bottom + top) / 2) * this.scale);
  }

  /** Moves as little as it takes to have a cell in sight. */
  reveal([column, row]) {
    const { x, y, width, height } = this.boxOf({ left: column, bottom: row, right: column + 1, top: row + 1 });
    this.x += Math.max(0, RULER - x) - Math.max(0, x + width - this.width);
    this.y += Math.max(0, RULER - y) - Math.max(0, y + height - this.height);
  }
}
