// SPDX-License-Identifier: Apache-2.0
// The upper of the two canvases: lanes, names, faults, the selection, what is about to be drawn.

import { tr } from '../language/texts.js';
import { isLetter, lookOf, NEXT_STATION } from './characters.js';
import { same } from './drawing.js';
import { drawHeat } from './heat_layer.js';
import { drawRulers, metres } from './rulers.js';
import { filled, head } from './sheet.js';

const NAMES_FROM = 7; // [px a cell]
const ROOMY = 18; // [px a cell] from which a station's figures have a line of their own
const EDGE = 0.45; // [cells] from a service cell's centre, where lanes end
const FLASH = 1200; // [ms] that a fault's cells are shown when it is chosen

export class Overlay {
  constructor(canvas, view) {
    Object.assign(this, { canvas, view, pen: canvas.getContext('2d'), colours: {}, chosen: null });
  }

  /** Shows which cells a chosen fault names, for a moment; `again` draws later. */
  flash(cells, again) {
    this.chosen = { cells, until: performance.now() + FLASH };
    setTimeout(again, FLASH + 20);
  }

  draw(state) {
    const { pen, view } = this;
    pen.setTransform(view.ratio, 0, 0, view.ratio, 0, 0);
    pen.clearRect(0, 0, view.width, view.height);
    this.services(state.drawing);
    if (state.heat) drawHeat(pen, view, state.heat);
    this.lanes(state);
    this.robots(state.drawing);
    this.faults(state.faults);
    this.names(state);
    this.pending(state);
    if (state.selection) this.frame(state.selection, state.drawing.spacing);
    if (state.cursor) this.cursor(state.cursor);
    drawRulers(pen, view, this.colours, state);
  }

  // --- stations

  /** Service cells of stations whose letter is not drawn. */
  services(drawing) {
    const { pen } = this, path = new Path2D();
    for (const { key, service } of drawing.stations) if (!isLetter(key)) this.mark(path, service, 1);
    filled(pen, path, this.colours.service);
  }

  /** Queues end and exits begin at the edge of the service cell: its letter stays free. */
  lanes({ drawing, lanesFound, station }) {
    for (const each of drawing.stations) {
      const { key, service } = each, found = lanesFound[key] ?? [];
      const at = found.findIndex((c) => same(c, service)), wide = each === station ? 0.16 : 0.1;
      for (const part of ['queue', 'exit']) {
        const isDrawn = each[part].length > 0;
        const cells = isDrawn ? each[part] : part === 'queue' ? found.slice(0, Math.max(at, 0)) : found.slice(at + 1);
        const way = part === 'queue' ? [...cells, service] : [service, ...cells];
        if (cells.length) this.way(way, part, wide, !isDrawn);
      }
    }
  }

  /** A line through the cells of a lane with a head at its end. */
  way(cells, part, wide, isDashed) {
    const { pen, view } = this, path = new Path2D(), points = cells.map((c) => view.centreOf(c));
    const [from, to] = part === 'queue' ? [points.length - 1, points.length - 2] : [0, 1];
    points[from] = [0, 1].map((i) => points[from][i] + EDGE * (points[to][i] - points[from][i]));
    points.forEach((p, i) => (i ? path.lineTo(...p) : path.moveTo(...p)));
    const last = cells.at(-1), before = cells.at(-2);
    pen.setLineDash(isDashed ? [view.scale * 0.25, view.scale * 0.2] : []);
    pen.lineWidth = Math.max(1.5, view.scale * wide);
    pen.strokeStyle = this.colours[part];
    pen.lineJoin = 'round';
    pen.stroke(path);
    pen.setLineDash([]);
    const tip = new Path2D();
    head(tip, points.at(-1), [last[0] - before[0], last[1] - before[1]], view.scale * 0.25);
    pen.stroke(tip);
  }

  names({ drawing, station, notes }) {
    const { pen, view, colours } = this;
    if (view.scale < NAMES_FROM) return;
    pen.font = '600 12px system-ui, sans-serif';
    pen.textAlign = 'left';
    pen.textBaseline = 'middle';
    for (const each of drawing.stations) {
      const [x, y] = view.centreOf(each.service), words = labelOf(each.name, notes?.[each.name], view.scale);
      const width = Math.max(...words.map((word) => pen.measureText(word).width)) + 10;
      const height = 15 * words.length + 4, top = y - view.scale * 0.4 - height;
      const left = Math.min(x + view.scale * 0.55, Math.max(x, view.width - 4) - width);
      pen.fillStyle = colours.ruler;
      pen.fillRect(left, top, width, height);
      pen.fillStyle = each === station ? colours.select : colours['ruler-text'];
      words.forEach((word, i) => pen.fillText(word, left + 5, top + 10 + 15 * i));
    }
  }

  robots(drawing) {
    if (!Array.isArray(drawing.robots)) return;
    const { pen, view } = this, path = new Path2D();
    for (const cell of drawing.robots) {
      const [x, y] = view.centreOf(cell), radius = view.scale * 0.28;
      path.moveTo(x + radius, y);
      path.arc(x, y, radius, 0, 2 * Math.PI);
    }
    filled(pen, path, this.colours.robot);
  }

  // --- faults

  faults(faults) {
    const { pen, view } = this, path = new Path2D();
    for (const { cells } of faults) for (const cell of cells) this.mark(path, cell, 1.5);
    pen.strokeStyle = this.colours.fault;
    pen.lineWidth = 2.5;
    pen.stroke(path);
    pen.globalAlpha = 0.22;
    filled(pen, path, this.colours.fault);
    pen.globalAlpha = 1;
    if (this.chosen && performance.now() < this.chosen.until) {
      const around = new Path2D();
      for (const cell of this.chosen.cells) this.mark(around, cell, -4);
      pen.lineWidth = 4;
      pen.stroke(around);
    } else this.chosen = null;
    pen.lineWidth = Math.max(1, view.scale / 14);
  }

  mark(path, [column, row], inset) {
    const { x, y, width } = this.view.boxOf({ left: column, bottom: row, right: column + 1, top: row + 1 });
    path.rect(x + inset, y + inset, width - 2 * inset, width - 2 * inset);
  }

  // --- what a tool is about to do

  pending({ ghost, brush, drawing }) {
    if (!ghost) return;
    const { pen } = this;
    pen.globalAlpha = 0.6;
    if (ghost.cells) {
      const look = lookOf(ghost.char ?? (brush === NEXT_STATION ? 'A' : brush)), path = new Path2D();
      for (const cell of ghost.cells) this.mark(path, cell, 0);
      filled(pen, path, this.colours[ghost.colour ?? look]);
    }
    if (ghost.block) this.block(ghost.block, ghost.at);
    pen.globalAlpha = 1;
    if (ghost.rect) this.frame(ghost.rect, drawing.spacing);
  }

  block({ rows }, [column, row]) {
    const { pen } = this;
    rows.forEach((line, y) => line.forEach((char, x) => {
      if (char === ' ') return;
      const path = new Path2D();
      this.mark(path, [column + x, row + y], 0);
      filled(pen, path, this.colours[lookOf(char)]);
    }));
  }

  /** A frame with its size in metres. */
  frame(rect, spacing) {
    const { pen, view, colours } = this, { x, y, width, height } = view.boxOf(rect);
    pen.strokeStyle = colours.select;
    pen.lineWidth = 2;
    pen.setLineDash([6, 4]);
    pen.strokeRect(x, y, width, height);
    pen.setLineDash([]);
    const text = `${metres((rect.right - rect.left) * spacing)} × ${metres((rect.top - rect.bottom) * spacing)} m`;
    pen.font = '600 12px system-ui, sans-serif';
    pen.textAlign = 'left';
    pen.textBaseline = 'middle';
    const wide = pen.measureText(text).width + 10, left = Math.max(26, x), top = Math.max(28, y - 21);
    pen.fillStyle = colours.select;
    pen.fillRect(left, top, wide, 18);
    pen.fillStyle = colours['on-station'];
    pen.fillText(text, left + 5, top + 9.5);
  }

  cursor(cell) {
    const { pen, view } = this;
    const { x, y, width } = view.boxOf({ left: cell[0], bottom: cell[1], right: cell[0] + 1, top: cell[1] + 1 });
    pen.strokeStyle = this.colours.select;
    pen.lineWidth = 3;
    pen.strokeRect(x - 1, y - 1, width + 2, width + 2);
  }
}

/** The lines at a station: its name, and its result in a trial. */
function labelOf(name, notes, scale) {
  if (!notes) return [name];
  return scale < ROOMY ? [`${name}: ${notes.queue}`] : [name, tr`queue ${notes.queue}, busy ${notes.busy}`];
}
