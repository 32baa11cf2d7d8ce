// SPDX-License-Identifier: Apache-2.0
// Draws the rows of a Gantt that are in sight, in the five colours of activities.

import { font } from '../base/charts.js';
import { token } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { before } from '../base/time.js';
import { ACTIVITY_CLASS } from '../base/words.js';

export const AXIS = 24; // its height [px]
const LEAST = [0.5, 0.5, 0.5, 1.5, 2]; // width of a span [px]: what matters can be seen when far away
const BAR = 0.72; // of a row's height

/** The colours of now. */
export function palette() {
  return { states: ACTIVITY_CLASS.map(token), text: token('text'), dim: token('dim'), line: token('line'), hover: token('hover'), accent: token('accent'), panel: token('panel') };
}

/** `rows` {row, share} from the number `first` on, whose top is at `y` [px]. */
export function paint(context, { rows, first, y, chosen, view, spans, colours, size: [width, height], shares }) {
  context.clearRect(0, 0, width, height);
  const text = `${font().size}px ${font().family}`;
  context.font = text;
  context.textBaseline = 'middle';
  names(context, { rows, first, y, chosen, view, colours, width, shares });
  context.save();
  context.beginPath();
  context.rect(view.left, AXIS, view.width, height - AXIS);
  context.clip();
  lines(context, view, colours, height);
  bars(context, { rows, y, view, spans, colours });
  context.restore();
  axis(context, view, colours, width);
}

function names(context, { rows, first, y, chosen, view, colours, width, shares }) {
  rows.forEach(({ row, share }, i) => {
    const top = y + i * view.rowHeight, middle = top + view.rowHeight / 2;
    if (first + i === chosen) {
      context.fillStyle = colours.hover;
      context.fillRect(0, top, width, view.rowHeight);
    }
    context.fillStyle = row.kind === 'station' ? colours.text : colours.dim;
    context.textAlign = 'left';
    context.fillText(row.name, 8, middle, view.left - (shares ? 56 : 16));
    if (!shares) return;
    context.fillStyle = colours.text;
    context.textAlign = 'right';
    context.fillText(`${Math.round(100 * share)} %`, view.left - 8, middle);
  });
}

function bars(context, { rows, y, view, spans, colours }) {
  const lists = colours.states.map(() => []);
  const from = view.start, to = from + view.span;
  rows.forEach(({ row }, i) => collect(lists, row, spans, view, from, to, y + i * view.rowHeight));
  const thick = Math.max(2, Math.round(BAR * view.rowHeight)), lift = (view.rowHeight - thick) / 2;
  lists.forEach((list, state) => { // what matters most is drawn last
    context.fillStyle = colours.states[state];
    for (let i = 0; i < list.length; i += 3) context.fillRect(list[i], list[i + 2] + lift, list[i + 1], thick);
  });
}

/** Adds x, width and top of a row's spans to the list of each state; of those within a pixel one. */
function collect(lists, row, spans, view, from, to, top) {
  const ends = lists.map(() => -1);
  for (let i = Math.max(0, row.indexAt(from)); i < row.times.length && row.times[i] < to; ++i) {
    const state = row.states[i];
    if (state >= lists.length) continue;
    const x0 = view.x(Math.max(from, spans.begin, row.times[i])), x1 = view.x(Math.min(to, row.times[i + 1] ?? spans.now));
    if (x1 <= x0 || x1 <= ends[state]) continue;
    const width = Math.max(LEAST[state], x1 - x0);
    ends[state] = x0 + Math.max(width, 0.75);
    lists[state].push(x0, width, top);
  }
}

function lines(context, view, colours, height) {
  context.fillStyle = colours.line;
  for (const { time } of view.ticks(view.width / 90)) context.fillRect(Math.round(view.x(time)), AXIS, 1, height);
}

function axis(context, view, colours, width) {
  context.fillStyle = colours.panel;
  context.fillRect(0, 0, width, AXIS);
  context.fillStyle = colours.dim;
  for (const { time, ago } of view.ticks(view.width / 90)) {
    const x = view.x(time);
    context.textAlign = x > width - 30 ? 'right' : x < view.left + 24 ? 'left' : 'center';
    context.fillText(ago ? tr`${before(ago)} ago` : tr`now`, x, AXIS / 2);
  }
  context.fillStyle = colours.line;
  context.fillRect(0, AXIS - 1, width, 1);
}

/** Draws the frame of a chosen span. */
export function outline(context, view, { from, to }, top, colour) {
  const x = Math.max(view.left, view.x(from)), end = Math.min(view.left + view.width, view.x(to));
  context.strokeStyle = colour;
  context.lineWidth = 2;
  context.strokeRect(x + 0.5, top + 1.5, Math.max(3, end - x - 1), view.rowHeight - 3);
}
