// SPDX-License-Identifier: Apache-2.0
// Try: ideal robots work in the drawing for ten simulated minutes; what they did is shown on it.

import { $, make, on, press } from '../base/dom.js';
import { swatches, topOf } from '../base/heat_scale.js';
import { number, percent } from '../language/numbers.js';
import { tr } from '../language/texts.js';
import { clock } from '../base/time.js';
import { send } from './server.js';
import { textOf } from './text.js';

const LEGEND = { traffic: tr`loaded robots through a cell`, waiting: tr`seconds that robots queued in a cell` };

export class Trial {
  constructor(editor) {
    Object.assign(this, { editor, abort: null, result: null, kind: 'traffic' });
    on($('try'), 'click', () => this.run());
    on($('trial-cancel'), 'click', () => this.abort?.abort());
    on($('trial-close'), 'click', () => this.close());
    for (const button of $('trial-kinds').children) on(button, 'click', () => this.show(button.dataset.heat));
    $('trial-scale').append(...swatches());
    editor.on('change', () => this.age());
  }

  async run() {
    this.abort?.abort();
    const abort = new AbortController();
    const { text, origin } = textOf(this.editor.drawing);
    Object.assign(this, { abort, before: this.result?.pieces_per_hour });
    this.phase('running', tr`robots come in …`);
    try {
      const answer = await send('POST', '/try', text, abort.signal);
      await linesOf(answer, (line) => this.take(line, origin));
      // A server that ended, or was killed for want of memory, closes the answer without a word.
      if ($('trial').dataset.phase === 'running') this.phase('failed', tr`The trial ended without a result; try again.`);
    } catch (error) {
      if (this.abort === abort) this.phase('failed', error.name === 'AbortError' ? tr`cancelled` : error.message);
    }
    if (this.abort === abort) this.abort = null;
  }

  /** A line of the server: the progress, or the result. */
  take({ time, of, pieces, waiting, result, error }, origin) {
    if (error) this.phase('failed', error);
    else if (result) this.end(result, origin);
    else {
      $('trial-bar').max = of;
      $('trial-bar').value = time;
      const queues = Object.values(waiting).reduce((a, b) => a + b, 0);
      this.phase('running', tr`${clock(time)} of ${clock(of)}: ${pieces} pieces, ${queues} units at stations or on their way`);
    }
  }

  end(result, origin) {
    Object.assign(this, { result, origin });
    this.phase('done', '');
    $('trial-pieces').textContent = number(result.pieces_per_hour);
    const share = result.pieces_per_hour / Math.max(1, result.most_pieces_per_hour);
    $('trial-of').textContent = tr`pieces an hour, ${Math.round(100 * share)} % of what the stations can do${this.comparison(result)}`;
    $('trial-text').textContent = tr`${result.pieces} pieces and ${result.orders} orders in ${clock(result.seconds)}, ideal robots, from a standstill`;
    $('trial-minutes').replaceChildren(...bars(result.per_minute));
    const rows = result.stations.map((s) => [s.name, { queue: number(s.queue, 1), busy: percent(s.busy) }]);
    $('trial-stations').replaceChildren(...rows.map(([name, { queue, busy }]) => (
      make('tr', {}, ...[name, queue, busy].map((textContent) => make('td', { textContent }))))));
    this.editor.notes = Object.fromEntries(rows);
    this.show(this.kind);
  }

  comparison({ pieces_per_hour: now }) {
    return this.before ? tr`; ${number(this.before)} before${now > this.before ? ' ↑' : now < this.before ? ' ↓' : ''}` : '';
  }

  show(kind) {
    this.kind = kind;
    for (const button of $('trial-kinds').children) press(button, button.dataset.heat === kind);
    const values = this.result[kind] ?? [], top = topOf(values);
    this.editor.heat = kind === 'none' ? null : { values, width: this.result.width, origin: this.origin, top };
    $('trial-legend').textContent = kind === 'none' ? '' : tr`${LEGEND[kind]}: 0 to ${Math.round(top)}`;
    $('trial-scale').hidden = kind === 'none';
    this.editor.redrawOverlay();
  }

  phase(name, text) {
    $('trial').hidden = false;
    $('trial').dataset.phase = name;
    $('trial-told').textContent = text;
    $('trial-told').hidden = !text;
    $('trial-running').hidden = name !== 'running';
    $('trial-done').hidden = name !== 'done';
    if (name !== 'running') $('trial-bar').removeAttribute('value');
  }

  /** The drawing has changed: the figures are of an earlier one. */
  age() {
    if ($('trial').dataset.phase !== 'done' || $('trial').hidden) return;
    this.phase('done', tr`This was before the last change; try again.`);
    this.editor.notes = null;
  }

  close() {
    const { abort } = this;
    // Let go of first: else run() would open the panel again, to say that it was cancelled.
    this.abort = null;
    abort?.abort();
    $('trial').hidden = true;
    Object.assign(this.editor, { heat: null, notes: null });
    this.editor.redrawOverlay();
  }
}

/** Calls `take` with each line of a response, parsed, as it comes. */
async function linesOf(answer, take) {
  let text = '';
  const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    const parts = (text + value).split('\n');
    text = parts.pop();
    for (const part of parts) take(JSON.parse(part));
  }
}

function bars(values) {
  const most = Math.max(1, ...values);
  return values.map((value, i) => {
    const out = make('i', { title: tr`minute ${i + 1}: ${value} pieces` });
    out.style.height = `${Math.max(2, (100 * value) / most)}%`;
    return out;
  });
}
