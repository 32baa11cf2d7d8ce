// SPDX-License-Identifier: Apache-2.0
// Scenarios side by side: a chart with intervals, what differs, and a table of figures.

import { $, make, on } from '../base/dom.js';
import { ROOT } from '../base/root.js';
import { tr } from '../language/texts.js';
import { queryOf } from './server.js';
import { chartOf, draw, unitOf } from './whiskers.js';
import { differences, interval, limitOf, number, runsOf } from './words.js';

const VERDICTS = { better: tr`better`, worse: tr`worse`, different: tr`different`, 'too few runs': tr`too few runs` };
const SIGNS = { better: '▲', worse: '▼', different: '◆' };

export class Comparison {
  /** choose(name): is called where a person makes another scenario the reference. */
  constructor(choose) {
    this.choose = choose;
    this.figures = this.chart = null;
    on($('figure'), 'change', () => this.draw());
    on(matchMedia('(prefers-color-scheme: light)'), 'change', () => this.draw());
  }

  /** Says why there is nothing to show. */
  clear(text) {
    this.figures = null;
    $('side-told').textContent = text;
    $('compared').hidden = $('report').hidden = true;
  }

  /** Shows the server's comparison; scenarios: those that are compared, in its order. */
  show(figures, scenarios, defaults) {
    Object.assign(this, { figures, scenarios });
    const left = scenarios.filter(({ state }) => state !== 'done').map(({ name }) => name);
    $('side-told').textContent = left.length ? tr`Of ${left.join(', ')} not all runs are over; figures are of those that are.` : '';
    $('compared').hidden = $('report').hidden = false;
    $('report').href = `${ROOT}/whatif/report.html?${queryOf(figures.names)}`;
    this.fillFigures();
    this.showTable(defaults);
    this.showNotes();
    this.draw();
  }

  fillFigures() {
    const select = $('figure'), chosen = select.value || 'pieces';
    select.replaceChildren(...this.figures.rows.map(({ key, title }) => make('option', { value: key, textContent: title })));
    select.value = chosen;
  }

  draw() {
    if (!this.figures) return;
    const row = this.figures.rows.find(({ key }) => key === $('figure').value);
    const shown = chartOf(this.figures.names, row);
    $('chart').setAttribute('aria-label', `${row.title}: ${this.figures.names.map((name, i) => `${name} ${interval(row.cells[i], row.digits)}`).join(', ')} ${row.unit}`);
    this.chart = draw($('chart'), shown, this.chart);
  }

  showTable(defaults) {
    const { names, rows } = this.figures;
    const head = make('tr', {}, make('td'), ...names.map((name, i) => this.header(name, i)));
    const differs = differences(this.scenarios, defaults)
      .map(([what, texts]) => make('tr', {}, rowHead(what), ...texts.map((text) => make('td', { textContent: text }))));
    const figures = rows.map((row) => make('tr', {}, rowHead(row.title, row.unit), ...row.cells.map((cell, i) => cellOf(row, cell, i))));
    const limit = make('tr', {}, rowHead(tr`What limits it`), ...this.figures.limits.map((cause) => make('td', { textContent: limitOf(cause) })));
    $('table').replaceChildren(make('thead', {}, head),
      make('tbody', {}, title(tr`What differs`, names.length), ...(differs.length ? differs : [nothing(names.length)])),
      make('tbody', {}, title(tr`What came of it`, names.length), ...figures, limit));
  }

  header(name, i) {
    const what = i ? make('button', { className: 'text-button', textContent: tr`compare with this`, ariaLabel: tr`compare with ${name}`, click: () => this.choose(name) })
      : make('span', { className: 'dim', textContent: tr`compared with` });
    return make('th', { scope: 'col' }, make('span', { className: 'column', textContent: name }), what);
  }

  showNotes() {
    const { warm_up: warmUp, rows } = this.figures;
    const counts = [...new Set(rows[0].cells.map(({ count }) => count))];
    const few = Math.min(...counts) < 3 ? tr` Fewer than three runs have no interval and say nothing about chance: give each scenario three repetitions or more.` : '';
    const after = rows.filter(({ note }) => note !== 'the whole shift').map(({ title: text }) => text.toLowerCase()).join('; ');
    $('notes').textContent = tr`Means of ${counts.map(runsOf).join(tr` and `)} with 95 % confidence intervals. Better and worse than ${this.figures.names[0]}: the difference seed by seed is above chance, or the same in each run`
      + tr` (p < 0.05, corrected for all differences in the table; its interval is, too).${few}`
      + tr` After a warm-up of ${number(warmUp)} min, the same for all: ${after}. The others: of the whole shift.`;
  }
}

function rowHead(text, unit = '') {
  return make('th', { scope: 'row' }, `${text} `, ...(unit ? [make('span', { className: 'dim unit', textContent: unitOf(unit) })] : []));
}

const title = (text, columns) => make('tr', { className: 'part' }, make('th', { colSpan: columns + 1, scope: 'colgroup', textContent: text }));
const nothing = (columns) => make('tr', {}, make('td', { colSpan: columns + 1, className: 'dim', textContent: tr`nothing: they are the same` }));

function cellOf({ digits, plain }, cell, i) {
  const out = make('td', {}, make('span', { className: 'mean', textContent: interval(cell, digits) }), ' ');
  if (!i || plain) return out;
  const verdict = cell.verdict ?? 'too few runs';
  const all = cell.alike ? tr` in each of ${cell.alike} runs` : '';
  const sign = SIGNS[verdict] ? `${SIGNS[verdict]} ` : '';
  const relative = SIGNS[verdict] && cell.relative !== null ? ` ${cell.relative > 0 ? '+' : ''}${number(100 * cell.relative, 1)} %` : '';
  out.append(make('span', { className: `verdict ${verdict.split(' ')[0]}`, textContent: `${sign}${VERDICTS[verdict] ?? verdict}${relative}${all}` }));
  return out;
}
