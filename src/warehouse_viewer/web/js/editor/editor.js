// SPDX-License-Identifier: Apache-2.0
// The layout editor: one drawing, one tool, one brush; listeners are notified of changes.

import { $ } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { clear, copied, mirrored, repeated, replaced, turned } from './blocks.js';
import { FLOOR } from './characters.js';
import { Drawing } from './drawing.js';
import { History } from './history.js';
import { Overlay } from './overlay.js';
import { cellsOf, rectOf } from './shapes.js';
import { coloursOf, Sheet } from './sheet.js';
import { drawingOf } from './text.js';
import { Paste, paint, TOOLS } from './tools.js';
import { View } from './view.js';

const PAPER = { left: 0, bottom: 0, right: 30, top: 18 }; // in sight at first

export class Editor {
  /** say(text, kind) shows the person a text. */
  constructor(say) {
    Object.assign(this, { say, drawing: new Drawing(), history: new History(), view: new View() });
    this.sheet = new Sheet($('sheet'), this.view);
    this.overlay = new Overlay($('overlay'), this.view);
    Object.assign(this, { brush: FLOOR, selection: null, cursor: null, pointer: null, clipboard: null });
    Object.assign(this, { stationKey: '', faults: [], lanesFound: {}, heat: null, notes: null, bounds: null });
    this.listeners = { change: [], draft: [], state: [] }; // of the drawing, amid a stroke; of what is chosen
    this.frames = []; // how long each took [ms]
    this.take('pen');
    new ResizeObserver(() => this.resize()).observe($('paper'));
  }

  /** Calls `listener` when the drawing has changed ('change'), when it changes amid a stroke ('draft'),
   *  or when what is chosen has changed ('state'). */
  on(what, listener) {
    this.listeners[what].push(listener);
  }

  notify(what) {
    for (const listener of this.listeners[what]) listener();
  }

  // --- changes of the drawing

  begin() {
    this.history.keep(this.drawing);
  }

  /** Shows all that is drawn. */
  drawn() {
    this.notify('draft');
    this.redraw();
  }

  /** The change that was begun is whole; `station` is chosen, if one came. */
  commit(station = null) {
    this.bounds = this.drawing.bounds();
    if (station) this.stationKey = station.key;
    if (this.heat) Object.assign(this, { heat: null, notes: null });
    this.notify('change');
    this.notify('state');
    this.redraw();
  }

  abandon() {
    this.drawing = this.history.forget() ?? this.drawing;
    this.redraw();
  }

  /** Changes the drawing at once by a function of it. */
  change(alter) {
    this.begin();
    this.commit(alter(this.drawing) ?? null);
  }

  undo() {
    this.tool.cancel();
    this.swap(this.history.undo(this.drawing));
  }

  redo() {
    this.swap(this.history.redo(this.drawing));
  }

  swap(drawing) {
    if (!drawing) return;
    this.drawing = drawing;
    this.commit();
  }

  /** Another drawing, of the server's JSON; null is empty paper. It can be taken back. */
  open(json, isFirst = false) {
    if (!isFirst) this.begin();
    this.drawing = json ? drawingOf(json) : new Drawing();
    Object.assign(this, { selection: null, stationKey: '', cursor: null });
    this.commit();
    this.fit();
  }

  // --- what is chosen

  get station() {
    return this.drawing.stations.find((s) => s.key === this.stationKey);
  }

  choose(station) {
    this.stationKey = station?.key ?? '';
    this.notify('state');
    this.redrawOverlay();
  }

  take(name) {
    this.tool?.cancel();
    this.toolName = name;
    this.tool = name === 'paste' ? new Paste(this) : TOOLS[name][3](this);
    this.tool.hover(this.pointer);
    if (name !== 'select' && name !== 'hand') this.selection = null;
    this.notify('state');
    this.redrawOverlay();
  }

  setBrush(char) {
    this.brush = char;
    if (['select', 'queue', 'exit', 'hand', 'paste'].includes(this.toolName)) this.take('pen');
    else if (!this.tool.isBusy) this.tool.hover(this.pointer);
    this.notify('state');
    this.redrawOverlay();
  }

  select(rect) {
    this.selection = rect;
    this.notify('state');
    this.redrawOverlay();
  }

  selectAll() {
    if (!this.bounds) return;
    this.take('select');
    this.select(this.bounds);
  }

  /** Gives up what is under way: the tool's, then the selection, then the station. */
  leave() {
    if (this.toolName === 'paste') this.take('pen');
    else if (this.tool.isBusy) this.tool.cancel();
    else if (this.selection) this.select(null);
    else this.choose(null);
    this.redraw();
  }

  // --- keys

  /** A character was typed: the brush, and it is drawn where there is a selection or a cursor. */
  type(char) {
    if (this.selection || this.cursor) this.draw(char);
    if (!this.selection) this.setBrush(char);
  }

  draw(char) {
    const { cursor, selection } = this;
    if (!selection && !cursor) return;
    this.change((drawing) => {
      if (selection && char === ' ') return clear(drawing, selection);
      return paint(drawing, selection ? cellsOf(selection) : [cursor], char);
    });
  }

  moveCursor(cell) {
    this.cursor = cell;
    this.view.reveal(cell);
    if (this.tool.isBusy) this.tool.move(cell);
    else this.tool.hover(this.toolName === 'paste' ? cell : null);
    this.pointAt(cell);
    this.redraw();
  }

  middle() {
    const { view } = this;
    return view.cellAt(view.width / 2, view.height / 2);
  }

  pointAt(cell) {
    this.pointer = cell;
    this.notify('state');
    this.redrawOverlay();
  }

  // --- blocks

  copy() {
    if (!this.selection) return;
    this.clipboard = copied(this.drawing, this.selection);
    this.say(tr`Copied ${this.clipboard.width} × ${this.clipboard.height} cells; paste them by Ctrl+V`);
    this.notify('state');
  }

  cut() {
    if (!this.selection) return;
    this.copy();
    this.change((drawing) => clear(drawing, this.selection));
  }

  paste() {
    if (!this.clipboard) {
      this.say(tr`Nothing was copied yet: mark an area, then copy`, 'refused');
      return;
    }
    const { pointer, cursor } = this;
    this.take('paste');
    this.tool.hover(cursor ?? pointer ?? this.middle());
    this.redrawOverlay();
  }

  /** Mirrors or turns what is marked, in its place; or what is about to be pasted. */
  turnBlock(how) {
    const turn = { x: (b) => mirrored(b, 'x'), y: (b) => mirrored(b, 'y'), turn: turned }[how];
    if (this.toolName === 'paste' && this.clipboard) {
      this.clipboard = turn(this.clipboard);
      this.tool.hover(this.pointer);
      this.redrawOverlay();
    } else if (this.selection) {
      const block = turn(copied(this.drawing, this.selection));
      this.begin();
      this.selection = replaced(this.drawing, this.selection, block);
      this.commit();
    }
  }

  repeat(columns, rows, gap) {
    if (!this.selection || columns * rows < 2) return;
    this.begin();
    this.selection = repeated(this.drawing, this.selection, columns, rows, gap);
    this.commit();
  }

  // --- the picture

  resize() {
    const paper = $('paper'), ratio = devicePixelRatio || 1;
    this.view.ratio = ratio;
    for (const canvas of [this.sheet.canvas, this.overlay.canvas]) {
      canvas.width = Math.round(paper.clientWidth * ratio);
      canvas.height = Math.round(paper.clientHeight * ratio);
    }
    const isFirst = !this.view.width;
    this.view.resize(paper.clientWidth, paper.clientHeight);
    if (isFirst) this.fit();
    else this.redraw();
  }

  fit() {
    this.view.show(this.bounds ?? PAPER);
    this.redraw();
  }

  /** Has cells in sight, and marks them for a moment. */
  showCells(cells) {
    if (!cells.length) return;
    const columns = cells.map((c) => c[0]), rows = cells.map((c) => c[1]);
    const rect = rectOf([Math.min(...columns), Math.min(...rows)], [Math.max(...columns), Math.max(...rows)]);
    const { seen: visible } = this.view;
    const isSeen = rect.left > visible.left && rect.right < visible.right && rect.bottom > visible.bottom && rect.top < visible.top - 1;
    if (!isSeen) this.view.show({ left: rect.left - 4, right: rect.right + 4, bottom: rect.bottom - 4, top: rect.top + 4 }, this.view.scale);
    this.overlay.flash(cells, () => this.redrawOverlay());
    this.redraw();
  }

  dress() {
    this.sheet.colours = this.overlay.colours = coloursOf();
    this.redraw();
  }

  redraw() {
    this.isStale = true;
    this.redrawOverlay();
  }

  redrawOverlay() {
    this.request ??= requestAnimationFrame(() => this.paint());
  }

  paint() {
    this.request = null;
    if (!this.view.width) return;
    const began = performance.now();
    if (this.isStale) this.sheet.draw(this.drawing);
    this.isStale = false;
    this.overlay.draw({ ...this, station: this.station, ghost: this.tool.ghost });
    this.frames.push(performance.now() - began);
    if (this.frames.length > 1000) this.frames.shift();
  }
}
