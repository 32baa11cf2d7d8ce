// SPDX-License-Identifier: Apache-2.0
// Metres along the upper and the left edge, from the lower left of what is drawn.

import { RULER } from './view.js';

const APART = 56; // [px] at least, between two numbers

export const metres = (value) => String(Math.round(value * 100) / 100);

/** The least of 1, 2, 5, 10, … [m] that is not below a length. */
export function stepOf(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((k) => k * power).find((step) => step >= least * 0.999);
}

export function drawRulers(pen, view, colours, { drawing, bounds, pointer }) {
  const { left: column, bottom: row } = bounds ?? { left: 0, bottom: 0 };
  const scale = view.scale / drawing.spacing; // [px a metre]
  const origin = [view.x + column * view.scale, view.y - row * view.scale], step = stepOf(APART / scale);
  pen.fillStyle = colours.ruler;
  pen.fillRect(0, 0, view.width, RULER);
  pen.fillRect(0, RULER, RULER, view.height);
  if (pointer) shade(pen, view, colours, pointer);
  pen.fillStyle = colours['ruler-text'];
  pen.font = '11px system-ui, sans-serif';
  pen.textBaseline = 'middle';
  pen.textAlign = 'left';
  for (let m = Math.ceil((RULER - origin[0]) / scale / step) * step; origin[0] + m * scale < view.width; m += step) {
    const x = Math.round(origin[0] + m * scale);
    pen.fillRect(x, RULER - 7, 1, 7);
    pen.fillText(metres(m), x + 3, RULER / 2);
  }
  for (let m = Math.ceil((origin[1] - view.height) / scale / step) * step; origin[1] - m * scale > RULER; m += step) {
    const y = Math.round(origin[1] - m * scale);
    pen.fillRect(RULER - 7, y, 7, 1);
    pen.save();
    pen.translate(RULER / 2, y - 3);
    pen.rotate(-Math.PI / 2);
    pen.fillText(metres(m), 0, 0);
    pen.restore();
  }
  pen.fillStyle = colours.ruler;
  pen.fillRect(0, 0, RULER, RULER);
  pen.fillStyle = colours['ruler-text'];
  pen.textAlign = 'center';
  pen.fillText('m', RULER / 2, RULER / 2);
}

/** Where the pointer is, on both rulers. */
function shade(pen, view, colours, [column, row]) {
  const { x, y, width, height } = view.boxOf({ left: column, bottom: row, right: column + 1, top: row + 1 });
  pen.fillStyle = colours.select;
  pen.globalAlpha = 0.35;
  pen.fillRect(x, 0, width, RULER);
  pen.fillRect(0, y, RULER, height);
  pen.globalAlpha = 1;
}
