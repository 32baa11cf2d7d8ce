// SPDX-License-Identifier: Apache-2.0
// The lower of the two canvases: the cells as they are drawn.

import { token } from '../base/dom.js';
import { CHARACTERS, isLetter, lookOf, NOTHING, POINTS } from './characters.js';

const GRID_FROM = 7, SIGNS_FROM = 9; // [px a cell] from which lines and signs are legible
const BLANK = new Set(['.', NOTHING, '#', '=']);
const LOOKS = [...new Set(CHARACTERS.map(({ look }) => look))];

/** Colours by the names of --cell-… and --editor-…. */
export function coloursOf() {
  const out = Object.fromEntries([...LOOKS, 'grid'].map((look) => [look, token(`cell-${look}`)]));
  for (const name of ['sign', 'on-storage', 'on-station', 'queue', 'exit', 'fault', 'select', 'ruler', 'ruler-text', 'robot']) {
    out[name] = token(`editor-${name}`);
  }
  return out;
}

export class Sheet {
  constructor(canvas, view) {
    Object.assign(this, { canvas, view, pen: canvas.getContext('2d', { alpha: false }), colours: {} });
  }

  /** Draws all that is in sight. */
  draw(drawing) {
    const { pen, view, colours } = this, { ratio } = view;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = colours.nothing;
    pen.fillRect(0, 0, view.width, view.height);
    const visible = clipped(view.seen, drawing);
    this.fill(drawing, visible);
    if (view.scale >= GRID_FROM) this.grid(view.seen);
    if (view.scale >= SIGNS_FROM) this.signs(drawing, visible);
  }

  /** Each look is one path of the runs of its cells. */
  fill(drawing, { left, bottom, right, top }) {
    const paths = {}, { pen, view } = this, { scale } = view;
    for (let row = bottom; row < top; row++) {
      const y = Math.round(view.y - (row + 1) * scale), height = Math.round(view.y - row * scale) - y;
      for (let column = left, begin = left; column < right; column++) {
        const char = drawing.get(column, row);
        if (column + 1 < right && drawing.get(column + 1, row) === char) continue;
        if (char !== NOTHING) {
          const x = Math.round(view.x + begin * scale);
          (paths[lookOf(char)] ??= new Path2D()).rect(x, y, Math.round(view.x + (column + 1) * scale) - x, height);
        }
        begin = column + 1;
      }
    }
    for (const [look, path] of Object.entries(paths)) {
      filled(pen, path, this.colours[look]);
    }
  }

  grid({ left, bottom, right, top }) {
    const { pen, view } = this, { scale } = view;
    pen.fillStyle = this.colours.grid;
    for (let column = left; column <= right; column++) pen.fillRect(Math.round(view.x + column * scale), 0, 1, view.height);
    for (let row = bottom; row <= top; row++) pen.fillRect(0, Math.round(view.y - row * scale), view.width, 1);
  }

  /** Arrows, letters, and signs that distinguish places, charging and keep-out without colours. */
  signs(drawing, { left, bottom, right, top }) {
    const signs = { arrows: new Path2D(), frames: new Path2D(), crosses: new Path2D(), words: [] };
    for (let row = bottom; row < top; row++) {
      for (let column = left; column < right; column++) {
        const char = drawing.get(column, row);
        if (!BLANK.has(char)) this.sign(signs, char, this.view.centreOf([column, row]));
      }
    }
    const { pen, view, colours } = this;
    pen.lineWidth = Math.max(1, view.scale / 14);
    pen.strokeStyle = colours.sign;
    pen.stroke(signs.arrows);
    pen.stroke(signs.crosses);
    pen.strokeStyle = colours['on-storage'];
    pen.stroke(signs.frames);
    this.words(signs.words);
  }

  sign({ arrows, frames, crosses, words }, char, centre) {
    const { scale } = this.view, [x, y] = centre;
    if (POINTS[char]) POINTS[char].forEach((heading) => arrow(arrows, centre, heading, scale));
    else if (char === 's') frames.rect(x - scale * 0.3, y - scale * 0.3, scale * 0.6, scale * 0.6);
    else if (char === 'x') cross(crosses, centre, scale * 0.25);
    else words.push([char, centre]);
  }

  words(words) {
    const { pen, view, colours } = this;
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    pen.font = `600 ${Math.round(view.scale * 0.55)}px system-ui, sans-serif`;
    for (const [char, [x, y]] of words) {
      pen.fillStyle = colours[isLetter(char) ? 'on-station' : 'sign'];
      pen.fillText(char.toUpperCase(), x, y + view.scale * 0.04);
    }
  }
}

export function filled(pen, path, colour) {
  pen.fillStyle = colour;
  pen.fill(path);
}

/** The part of a rectangle that is on the paper. */
function clipped({ left, bottom, right, top }, drawing) {
  return {
    left: Math.max(left, drawing.left),
    bottom: Math.max(bottom, drawing.bottom),
    right: Math.min(right, drawing.left + drawing.width),
    top: Math.min(top, drawing.bottom + drawing.height),
  };
}

/** An arrow of half a cell, its head towards [dx, dy]. */
function arrow(path, [x, y], [dx, dy], scale) {
  const long = scale * 0.3, tip = [x + dx * long, y - dy * long];
  path.moveTo(x - dx * long, y + dy * long);
  path.lineTo(...tip);
  head(path, tip, [dx, dy], scale * 0.15);
}

/** The head of an arrow that points to [dx, dy]. */
export function head(path, tip, [dx, dy], size) {
  path.moveTo(tip[0] - (dx + dy) * size, tip[1] + (dy - dx) * size);
  path.lineTo(...tip);
  path.lineTo(tip[0] - (dx - dy) * size, tip[1] + (dy + dx) * size);
}

function cross(path, [x, y], half) {
  path.moveTo(x - half, y - half);
  path.lineTo(x + half, y + half);
  path.moveTo(x - half, y + half);
  path.lineTo(x + half, y - half);
}
