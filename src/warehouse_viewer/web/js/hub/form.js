// SPDX-License-Identifier: Apache-2.0
// The form of a new warehouse: a field for each argument of the launch files, with its documentation.

import { $, make, on } from '../base/dom.js';
import { tr } from '../language/texts.js';
import * as server from './server.js';

const FIRST = ['size', 'layout', 'robots', 'world', 'orders', 'realism', 'rtf', 'seed'];
const FILES = { shift: 'operations.launch', empty: 'empty_world.launch', '': 'warehouse.launch' };

export class WishForm {
  /** `done(row)` is called with the simulation that begins. */
  constructor(done) {
    this.form = $('wish-form');
    this.done = done;
    on(this.form, 'submit', (event) => { event.preventDefault(); this.send(); });
    on($('wish-cancel'), 'click', () => $('wish').close());
    on(this.form.elements.kind, 'change', () => this.showKind());
  }

  async open(name) {
    if (!this.fields) await this.build();
    this.form.elements.name.value = name;
    this.showFault('', '');
    this.showKind();
    $('wish').showModal();
  }

  async build() {
    const { worlds, arguments: rows } = await server.argumentsOf();
    $('worlds').replaceChildren(...worlds.map((value) => make('option', { value })));
    this.fields = new Map(rows.map((row) => [row.name, this.fieldOf(row)]));
    const names = [...this.fields.keys()];
    const first = FIRST.filter((name) => this.fields.has(name));
    $('fields').replaceChildren(...first.map((name) => this.fields.get(name).label));
    $('more').replaceChildren(...names.filter((name) => !FIRST.includes(name)).map((name) => this.fields.get(name).label));
  }

  fieldOf(row) {
    const input = row.choices.length
      ? make('select', { name: row.name }, new Option(tr`(default)`, ''), ...row.choices.filter(Boolean).map((text) => new Option(text, text)))
      : make('input', { name: row.name, placeholder: row.default, autocomplete: 'off', spellcheck: false });
    if (row.name === 'world') input.setAttribute('list', 'worlds');
    const wrong = make('span', { className: 'wrong', role: 'alert', hidden: true });
    const parts = [row.name, input, make('small', { textContent: row.documentation }), wrong];
    if (row.name === 'layout' || row.name === 'world') parts.splice(2, 0, fileInput(input));
    const label = make('label', {}, ...parts);
    on(input, 'input', () => { wrong.hidden = true; });
    return { row, input, wrong, label };
  }

  showKind() {
    const file = FILES[this.form.elements.kind.value];
    for (const { row, label } of this.fields.values()) label.hidden = !row.files.includes(file);
  }

  wish() {
    const kind = this.form.elements.kind.value;
    const out = { name: this.form.elements.name.value.trim() };
    if (kind) out[kind] = true;
    for (const [name, { input, label }] of this.fields) {
      const value = input.dataset.content ?? input.value.trim();
      if (value && !label.hidden) out[name] = value;
    }
    return out;
  }

  async send() {
    this.showFault('', '');
    const answer = await fetch('/api/v1/simulations', {
      method: 'POST', body: JSON.stringify(this.wish()), headers: { 'content-type': 'application/json' },
    }).catch(() => null);
    const body = await answer?.json().catch(() => ({})) ?? { detail: tr`the hub does not answer` };
    if (answer?.ok) {
      $('wish').close();
      this.done(body);
    } else this.showFault(body.field, body.reason && this.fields.has(body.field) ? body.reason : body.detail, body.nearest);
  }

  /** Says beside a field what is wrong with it, or below the form. */
  showFault(name, text, nearest = '') {
    for (const { wrong } of this.fields?.values() ?? []) wrong.hidden = true;
    const field = this.fields?.get(name);
    $('wish-answer').hidden = !text || Boolean(field);
    $('wish-answer').textContent = text;
    if (!field) return;
    field.wrong.textContent = nearest ? tr`${text} Nearest: ${nearest}.` : text;
    field.wrong.hidden = false;
    field.label.closest('details')?.setAttribute('open', '');
    field.input.focus();
  }
}

/** A button that opens a file, whose text is then the value of the input. */
function fileInput(input) {
  const file = make('input', { type: 'file', ariaLabel: tr`a file for ${input.name}` });
  on(file, 'change', async () => {
    if (!file.files[0]) return;
    input.dataset.content = await file.files[0].text();
    input.value = file.files[0].name;
  });
  on(input, 'input', () => delete input.dataset.content);
  return file;
}
