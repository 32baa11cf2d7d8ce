// SPDX-License-Identifier: Apache-2.0
// Where robots drove or waited in a trial, on the drawing.

import { STOPS } from '../base/heat_scale.js';

/** Which of the STOPS shows a value. */
const stopOf = (value, top) => Math.min(STOPS.length - 1, Math.floor((value / top) * STOPS.length));

/** heat: {values, width, origin, top}; values by cell from the cell `origin` on, row by row. */
export function drawHeat(pen, view, { values, width, origin, top }) {
  const paths = STOPS.map(() => new Path2D()), { scale } = view;
  values.forEach((value, i) => {
    if (value <= 0) return;
    const [x, y] = view.centreOf([origin[0] + (i % width), origin[1] + Math.floor(i / width)]);
    paths[stopOf(value, top)].rect(x - scale / 2, y - scale / 2, scale, scale);
  });
  pen.globalAlpha = 0.72;
  paths.forEach((path, i) => {
    pen.fillStyle = `rgb(${STOPS[i]})`;
    pen.fill(path);
  });
  pen.globalAlpha = 1;
}
