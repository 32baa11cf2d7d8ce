// SPDX-License-Identifier: Apache-2.0
// The dialog in which a search for a layout is described. What the server refuses is said beside
// the field that it is about.

import { $, make, on } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { choose, fillLayouts, freeName, option } from './choices.js';
import { demandOf, demandText, EDGES, edgesOf } from './design_words.js';
import { ask } from './server.js';
import { duration, layoutOf } from './words.js';

const PAUSE = 350; // [ms] after a change, until the server is asked about it
const FIELDS = ['name', 'building', 'demand', 'costs', 'late', 'cpu_hours', 'physics_hours', 'seed'];

export class DesignForm {
  /** keep(name, settings): makes a search and runs it; rejects with the reason. */
  constructor(about, keep) {
    Object.assign(this, { about, keep, asked: 0 });
    this.dialog = $('designer');
    for (const field of FIELDS) {
      const said = make('span', { className: 'refusal', id: `design-${field}-said` });
      $(`design-${field}-label`).append(said);
      $(`design-${field}`).setAttribute('aria-describedby', said.id);
    }
    on($('design-form'), 'submit', (event) => {
      event.preventDefault();
      this.send();
    });
    on($('design-cancel'), 'click', () => this.dialog.close());
    on($('design-form'), 'input', () => this.changed());
  }

  /** Opens the dialog with settings; taken: the names of searches. */
  open(settings, taken) {
    this.taken = taken;
    this.take(settings);
    $('design-lack').textContent = this.about.lacks;
    $('design-lack').hidden = !this.about.lacks;
    $('design-run').disabled = Boolean(this.about.lacks);
    $('design-name').value = this.alike = this.stem();
    this.refuse('', '');
    this.dialog.showModal();
    $('design-building').focus();
    this.changed();
  }

  take({ building, demand, late, cpu_hours: hours, seed, physics_hours: physics }) {
    const isEdges = EDGES.test(building);
    this.fillBuildings(isEdges ? '' : building);
    if (isEdges) $('design-edges').value = building;
    const { file, times } = demandOf(demand);
    this.fillFiles(file);
    $('design-times').value = times;
    $('design-late').value = Number((100 * late).toPrecision(6));
    $('design-cpu_hours').value = hours;
    $('design-physics_hours').value = Math.round(60 * physics);
    $('design-seed').value = seed;
  }

  fillBuildings(chosen = $('design-building').value) {
    fillLayouts($('design-building'), this.about, '');
    $('design-building').prepend(option('', tr`an empty hall`));
    $('design-building').value = '';
    choose($('design-building'), chosen);
  }

  fillFiles(chosen = $('design-demand').value) {
    $('design-demand').replaceChildren(...this.about.orders.map((name) => option(name)));
    choose($('design-demand'), chosen);
  }

  /** Takes a file that has just been opened. */
  took(kind, name) {
    if (kind === 'layouts') this.fillBuildings(name);
    if (kind === 'orders') this.fillFiles(name);
    this.changed();
  }

  settings() {
    return {
      building: $('design-building').value || edgesOf($('design-edges').value),
      demand: demandText({ file: $('design-demand').value, times: $('design-times').valueAsNumber || 1 }),
      late: $('design-late').valueAsNumber / 100 || 0,
      cpu_hours: $('design-cpu_hours').valueAsNumber || 0,
      seed: $('design-seed').valueAsNumber || 0,
      physics_hours: ($('design-physics_hours').valueAsNumber || 0) / 60,
    };
  }

  stem() {
    return freeName($('design-building').value ? layoutOf($('design-building').value) : edgesOf($('design-edges').value), this.taken);
  }

  changed() {
    $('design-edges-label').hidden = $('design-building').value !== '';
    $('design-costs').value = this.about.costs ? tr`those of costs.yaml` : tr`none yet`;
    if ($('design-name').value === this.alike) $('design-name').value = this.alike = this.stem();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.estimate(), PAUSE);
  }

  /** Asks the server whether that can be searched, and for how long. */
  async estimate() {
    this.asked += 1;
    const turn = this.asked;
    try {
      const { seconds, processes } = await ask('POST', '/designs/estimate', { settings: this.settings() });
      if (turn === this.asked) this.refuse('', tr`It takes about ${duration(seconds / processes)} here${this.settings().physics_hours ? tr`, and its last layouts some minutes with physics` : ''}.`, '');
    } catch (error) {
      if (turn === this.asked) this.refuse(error.field, error.message);
    }
  }

  /** Says why the server refuses, beside a field; '': below all of them. */
  refuse(field, text, kind = 'refused') {
    for (const each of FIELDS) {
      const isIt = each === field;
      $(`design-${each}-said`).textContent = isIt ? text : '';
      if (isIt) $(`design-${each}`).setAttribute('aria-invalid', 'true');
      else $(`design-${each}`).removeAttribute('aria-invalid');
    }
    const isElsewhere = !FIELDS.includes(field);
    $('design-said').textContent = isElsewhere ? text : '';
    $('design-said').dataset.kind = isElsewhere ? kind : '';
  }

  async send() {
    clearTimeout(this.timer);
    this.asked += 1;
    try {
      await this.keep($('design-name').value, this.settings());
      this.dialog.close();
    } catch (error) {
      this.refuse(error.field, error.message);
    }
  }
}
