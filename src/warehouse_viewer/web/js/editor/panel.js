// SPDX-License-Identifier: Apache-2.0
// Name, spacing, counts and sizes beside the drawing; and what is under the pointer below it.

import { $, on } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { CHARACTERS, isLetter } from './characters.js';
import { metres } from './rulers.js';

const WORDS = Object.fromEntries(CHARACTERS.map(({ char, word }) => [char, word]));
const FIELDS = ['name', 'spacing', 'units', 'robots', 'items'];

export class Panel {
  constructor(editor) {
    this.editor = editor;
    for (const field of FIELDS) on($(`own-${field}`), 'change', () => this.take(field));
    on($('repeat'), 'click', () => editor.repeat(number('repeat-columns'), number('repeat-rows'), number('repeat-gap')));
    for (const [id, act] of Object.entries(this.buttons())) on($(id), 'click', act);
    editor.on('change', () => this.show());
    editor.on('state', () => this.showState());
    this.show();
    this.showState();
  }

  buttons() {
    const { editor } = this;
    return {
      'undo': () => editor.undo(),
      'redo': () => editor.redo(),
      'copy': () => editor.copy(),
      'cut': () => editor.cut(),
      'paste': () => editor.paste(),
      'mirror-x': () => editor.turnBlock('x'),
      'mirror-y': () => editor.turnBlock('y'),
      'turn': () => editor.turnBlock('turn'),
      'fit': () => editor.fit(),
      'zoom-in': () => this.zoom(1.25),
      'zoom-out': () => this.zoom(0.8),
    };
  }

  zoom(factor) {
    this.editor.view.zoom(factor);
    this.editor.redraw();
  }

  /** A field was changed: what it says, where that can be meant. */
  take(field) {
    const text = $(`own-${field}`).value.trim(), value = READ[field](text);
    if (value === undefined) this.editor.say(tr`${text || tr`nothing`}: ${EXPECTED[field]} was expected`, 'refused');
    else this.editor.change((drawing) => { Object.assign(drawing, value); });
    this.show();
  }

  show() {
    const { drawing, bounds, history } = this.editor, { spacing } = drawing;
    $('own-name').value = drawing.name;
    $('own-spacing').value = spacing;
    $('own-units').value = unitsText(drawing);
    $('own-robots').value = drawing.robotCount;
    $('own-items').value = drawing.stock || (drawing.items === null ? '' : drawing.items);
    $('own-items').placeholder = tr`${drawing.itemCount} (4 a unit)`;
    $('own-items').disabled = Boolean(drawing.stock);
    const size = bounds ? [bounds.right - bounds.left, bounds.top - bounds.bottom] : [0, 0];
    const counts = { robots: drawing.robotCount, parking: drawing.count('p') + drawing.count('c'), units: drawing.unitCount,
      places: drawing.places, stations: drawing.stations.length, size: size.map((n) => metres(n * spacing)).join(' × ') };
    for (const [what, count] of Object.entries(counts)) $(`count-${what}`).textContent = count;
    $('undo').disabled = !history.past.length;
    $('redo').disabled = !history.future.length;
    document.title = tr`${drawing.name || tr`Layout`} – Kiva warehouse`;
  }

  showState() {
    const { editor } = this, { selection, pointer, bounds, drawing, toolName } = editor;
    const hasBlock = Boolean(selection) || toolName === 'paste';
    $('block').hidden = !hasBlock;
    for (const id of ['copy', 'cut', 'repeat']) $(id).disabled = !selection;
    $('paste').disabled = !editor.clipboard;
    $('where').textContent = pointer ? whereText(pointer, bounds, drawing) : '';
  }
}

const number = (id) => Math.max(0, Math.floor($(id).valueAsNumber || 0));

const unitsText = ({ units, isShare, unitCount }) => (
  Array.isArray(units) ? tr`${unitCount} (each in its place)` : isShare ? `${Math.round(units * 1000) / 10} %` : units);

/** Cell, metres and what is drawn there. */
function whereText(cell, bounds, drawing) {
  const [column, row] = [cell[0] - (bounds?.left ?? 0), cell[1] - (bounds?.bottom ?? 0)];
  const char = drawing.get(...cell), owner = drawing.ownerOf(cell);
  const word = owner ? `${owner.station.name}: ${owner.part}` : isLetter(char) ? tr`station ${char}` : WORDS[char];
  return `[${column}, ${row}]   ${metres((column + 0.5) * drawing.spacing)} m, ${metres((row + 0.5) * drawing.spacing)} m   ${word}`;
}

const whole = (text) => (/^\d{1,6}$/.test(text) ? Number(text) : undefined);
const EXPECTED = {
  name: tr`a name`,
  spacing: tr`the edge of a cell from 0.1 to 10 metres`,
  units: tr`a share like 85 % or a count`,
  robots: tr`a count`,
  items: tr`a count, or nothing`,
};
const READ = {
  name: (text) => ({ name: text }),
  spacing: (text) => (Number(text) >= 0.1 && Number(text) <= 10 ? { spacing: Number(text) } : undefined),
  units(text) {
    const share = /^(\d+(\.\d*)?|\.\d+) *%$/.test(text) ? parseFloat(text) / 100 : /^(0?\.\d+|1\.0+)$/.test(text) ? Number(text) : NaN;
    if (share >= 0 && share <= 1) return { units: share, isShare: true };
    const units = whole(text);
    return units === undefined ? undefined : { units, isShare: false };
  },
  robots(text) {
    const robots = whole(text);
    return robots === undefined ? undefined : { robots };
  },
  items(text) {
    const items = text ? whole(text) : null;
    return items === undefined ? undefined : { items };
  },
};
