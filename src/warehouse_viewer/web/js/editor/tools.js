// SPDX-License-Identifier: Apache-2.0
// What a pointer does on the paper: each tool has down(cell), move(cell), up(cell), cancel(), and
// says in `ghost` what it is about to do. The keys lead a tool the same way, by the cursor.

import { tr } from '../language/texts.js';
import { isLetter, NEXT_STATION } from './characters.js';
import { putIn } from './blocks.js';
import { clicked, drawLane, extended, laneOf } from './lanes.js';
import { areaCells, lineCells, outlineCells, rectangleCells, rectOf, straightCells } from './shapes.js';

/** Draws a brush in cells: a station is but one, in the last of them. */
export function paint(drawing, cells, brush) {
  if (brush === NEXT_STATION) return drawing.addStation(cells.at(-1));
  const where = isLetter(brush) ? cells.slice(-1) : cells;
  for (const [column, row] of where) drawing.set(column, row, brush);
  return isLetter(brush) ? drawing.ownerOf(cells.at(-1))?.station : null;
}

class Tool {
  constructor(editor) {
    this.editor = editor;
    this.ghost = null;
  }

  get isBusy() {
    return Boolean(this.from);
  }

  /** What the pointer would draw where it is. */
  hover(cell) {
    this.ghost = cell && { cells: [cell] };
  }

  cancel() {
    this.from = null;
    this.ghost = null;
  }
}

/** Freehand. A station is placed once a stroke: it moves with the pointer no farther. */
class Pen extends Tool {
  down(cell) {
    this.editor.begin();
    this.from = cell;
    this.station = paint(this.editor.drawing, [cell], this.editor.brush);
    this.ghost = null;
    this.editor.drawn();
  }

  move(cell) {
    if (!this.from) return;
    if (!this.station) paint(this.editor.drawing, lineCells(this.from, cell), this.editor.brush);
    this.from = cell;
    this.editor.drawn();
  }

  up() {
    this.from = null;
    this.editor.commit(this.station);
  }

  cancel() {
    if (this.from) this.editor.abandon();
    super.cancel();
  }
}

/** A line, a rectangle or an outline from where the pointer goes down to where it comes up. */
class Shape extends Tool {
  down(cell) {
    this.from = cell;
    this.move(cell);
  }

  move(cell) {
    if (!this.from) return;
    this.ghost = { cells: this.cells(this.from, cell), rect: rectOf(this.from, cell) };
  }

  up(cell) {
    if (!this.from) return;
    this.editor.begin();
    const station = paint(this.editor.drawing, this.cells(this.from, cell), this.editor.brush);
    this.cancel();
    this.editor.commit(station);
  }
}

class Line extends Shape {
  cells(a, b) {
    return straightCells(a, b);
  }

  move(cell) {
    super.move(cell);
    if (this.ghost) this.ghost.rect = rectOf(this.from, this.ghost.cells.at(-1));
  }
}

class Rectangle extends Shape {
  cells(a, b) {
    return rectangleCells(a, b);
  }
}

class Outline extends Shape {
  cells(a, b) {
    return outlineCells(a, b);
  }
}

class Fill extends Tool {
  down(cell) {
    const { editor } = this, cells = areaCells(editor.drawing, cell);
    if (!cells) {
      editor.say(tr`The empty paper has no end: draw a closed outline first, or a rectangle`, 'refused');
      return;
    }
    editor.begin();
    editor.commit(paint(editor.drawing, cells, editor.brush));
  }

  move() {}
  up() {}
}

class Select extends Tool {
  down(cell) {
    this.from = cell;
    this.editor.select(rectOf(cell, cell));
  }

  move(cell) {
    if (this.from) this.editor.select(rectOf(this.from, cell));
  }

  up(cell) {
    const isClick = this.from && `${this.from}` === `${cell}`;
    const owner = isClick && this.editor.drawing.ownerOf(cell);
    this.from = null;
    if (owner) this.editor.choose(owner.station);
  }

  hover() {}
}

/** A queue or an exit of the chosen station, as `part` says. */
class Lane extends Tool {
  constructor(editor, part) {
    super(editor);
    this.part = part;
    this.path = [];
  }

  down(cell) {
    const { editor } = this, owner = editor.drawing.ownerOf(cell);
    if (owner?.part === 'service') editor.choose(owner.station);
    if (!editor.station) {
      editor.say(tr`Choose a station first: click its letter, or its name in the list`, 'refused');
      return;
    }
    this.from = cell;
    this.path = [cell];
    this.show();
  }

  move(cell) {
    if (!this.from) return;
    this.path = extended(this.path, cell);
    this.show();
  }

  show() {
    this.ghost = { cells: this.path, colour: this.part };
  }

  up() {
    const { editor, path, part } = this, { station } = editor;
    this.cancel();
    if (!station || !path.length) return;
    const cells = path.length > 1 ? laneOf(path, station, part) : clicked(station, part, path[0]);
    this.path = [];
    if (`${cells}` === `${station[part]}`) return;
    editor.begin();
    drawLane(editor.drawing, editor.station, part, cells);
    editor.commit(editor.station);
  }

  hover(cell) {
    this.ghost = cell && { cells: [cell], colour: this.part };
  }
}

/** Puts in what was copied, at each click, until another tool is taken. */
export class Paste extends Tool {
  hover(cell) {
    const { clipboard } = this.editor;
    this.ghost = cell && clipboard && { block: clipboard, at: cell, rect: this.rect(cell) };
  }

  rect([left, bottom]) {
    const { width, height } = this.editor.clipboard;
    return { left, bottom, right: left + width, top: bottom + height };
  }

  down(cell) {
    const { editor } = this;
    if (!editor.clipboard) return;
    editor.begin();
    putIn(editor.drawing, editor.clipboard, cell);
    editor.commit();
  }

  move() {}
  up() {}
}

/** Moves the paper; see pointer.js. */
export class Hand extends Tool {
  down() {}
  move() {}
  up() {}
  hover() {}
}

/** The tools by name: [key, word, what it does, tool]. */
export const TOOLS = {
  pen: ['d', tr`draw`, tr`Draw freehand`, (e) => new Pen(e)],
  line: ['l', tr`line`, tr`Draw a straight line`, (e) => new Line(e)],
  rectangle: ['r', tr`rectangle`, tr`Draw a full rectangle`, (e) => new Rectangle(e)],
  outline: ['o', tr`outline`, tr`Draw the edge of a rectangle: walls, a ring of streets`, (e) => new Outline(e)],
  fill: ['f', tr`fill`, tr`Fill an area of one character`, (e) => new Fill(e)],
  select: ['m', tr`mark`, tr`Mark an area to copy, mirror or repeat; click a station to choose it`, (e) => new Select(e)],
  queue: ['q', tr`queue`, tr`Draw the queue of the chosen station, up to its letter`, (e) => new Lane(e, 'queue')],
  exit: ['e', tr`exit`, tr`Draw the way out of the chosen station, from its letter on`, (e) => new Lane(e, 'exit')],
  hand: ['h', tr`move`, tr`Move the paper (also with the right mouse button or two fingers)`, (e) => new Hand(e)],
};
