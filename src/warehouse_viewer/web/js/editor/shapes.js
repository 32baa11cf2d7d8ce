// SPDX-License-Identifier: Apache-2.0
// The cells of lines, rectangles and areas.

const MOST = 250000; // cells of an area

/** The cells of a line, each beside the one before: streets and lanes go on. */
export function lineCells([x, y], [toX, toY]) {
  const out = [[x, y]], dx = Math.abs(toX - x), dy = Math.abs(toY - y);
  let across = 0, up = 0;
  while (across < dx || up < dy) {
    if ((0.5 + across) * dy < (0.5 + up) * dx) across++;
    else up++;
    out.push([x + across * Math.sign(toX - x), y + up * Math.sign(toY - y)]);
  }
  return out;
}

/** Straight along the longer way. */
export function straightCells([x, y], [toX, toY]) {
  return lineCells([x, y], Math.abs(toX - x) >= Math.abs(toY - y) ? [toX, y] : [x, toY]);
}

/** {left, bottom, right, top} between two cells, the last two beyond them. */
export function rectOf(a, b) {
  const [left, right] = [Math.min(a[0], b[0]), Math.max(a[0], b[0]) + 1];
  const [bottom, top] = [Math.min(a[1], b[1]), Math.max(a[1], b[1]) + 1];
  return { left, bottom, right, top };
}

export function cellsOf({ left, bottom, right, top }) {
  const out = [];
  for (let row = bottom; row < top; row++) for (let column = left; column < right; column++) out.push([column, row]);
  return out;
}

export const rectangleCells = (a, b) => cellsOf(rectOf(a, b));

export function outlineCells(a, b) {
  const { left, bottom, right, top } = rectOf(a, b);
  const isEdge = ([column, row]) => column === left || row === bottom || column === right - 1 || row === top - 1;
  return rectangleCells(a, b).filter(isEdge);
}

/** The cells that hang together with one and have its character; null where they have no end. */
export function areaCells(drawing, start) {
  const char = drawing.get(...start), seen = new Set([`${start}`]), out = [start];
  if (!drawing.holds(...start)) return null;
  for (let i = 0; i < out.length; i++) {
    const [column, row] = out[i];
    for (const next of [[column + 1, row], [column - 1, row], [column, row + 1], [column, row - 1]]) {
      if (drawing.get(...next) !== char || seen.has(`${next}`)) continue;
      if (!drawing.holds(...next) || out.length > MOST) return null;
      seen.add(`${next}`);
      out.push(next);
    }
  }
  return out;
}
