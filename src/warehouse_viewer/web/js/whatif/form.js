// SPDX-License-Identifier: Apache-2.0
// The dialog in which a scenario is made and changed.

import { $, on } from '../base/dom.js';
import { plural, tr } from '../language/texts.js';
import { choose, fillDays, fillLayouts, fillPolicies, freeName, hintCounts, option, ordersText, partsOf, policiesOf, fitsOrders } from './choices.js';
import { eventsOf, linesOf, refusalOf } from './events.js';
import { faultOf, goToFault } from './numbers.js';
import { ask } from './server.js';
import { dayOf, duration, layoutOf, robotsOf } from './words.js';

const PAUSE = 350; // [ms] after a change, until the server is asked about it
const count = (what) => $(`own-${what}`).valueAsNumber || 0;
const KINDS = {
  fill: tr`never run out`, mix: tr`arrive at a rate`, file: tr`of a CSV file`, day: tr`a day as it was (CSV)`, demand: tr`days as described (.demand.yaml)`,
};
const OF_FILES = ['file', 'day', 'demand'];

export class Form {
  /** keep(name, settings, runs, old): makes or changes a scenario; rejects with the reason. */
  constructor(about, keep) {
    Object.assign(this, { about, keep, asked: 0 });
    this.dialog = $('editor');
    fillDays($('own-day'));
    fillPolicies($('policies'), about);
    for (const [name, most] of Object.entries(about.most)) if ($(`own-${name}`)) $(`own-${name}`).max = most;
    on($('editor-form'), 'submit', (event) => {
      event.preventDefault();
      this.send(true);
    });
    on($('editor-save'), 'click', () => this.send(false));
    on($('editor-cancel'), 'click', () => this.dialog.close());
    on($('editor-form'), 'input', () => this.changed());
    on($('own-orders'), 'change', () => this.fillFiles());
    on($('own-layout'), 'change', () => this.renameAlike());
  }

  /** Opens the dialog: of a scenario that is there (`old`, its name), or of a new one. */
  open(settings, { old = '', taken = [], hasRuns = false } = {}) {
    Object.assign(this, { old, taken, hasRuns });
    $('editor-title').textContent = old ? tr`Change ${old}` : tr`New scenario`;
    $('own-name').value = old || freeName(layoutOf(settings.layout), taken);
    $('own-name').disabled = Boolean(old);
    this.take(settings);
    this.dialog.showModal();
    $('own-layout').focus();
    this.changed();
  }

  /** Shows settings in the fields. */
  take(settings) {
    fillLayouts($('own-layout'), this.about, settings.layout);
    const parts = partsOf(settings.orders);
    const kinds = Object.entries(KINDS).map(([value, text]) => option(value, text));
    $('own-orders').replaceChildren(...kinds);
    choose($('own-orders'), parts.kind);
    this.fillFiles(parts.file);
    $('own-events').value = linesOf(settings.events).join('\n');
    $('events').open = Boolean(settings.events?.length);
    for (const what of ['rate', 'lines', 'pieces', 'times']) $(`own-${what}`).value = parts[what];
    for (const what of ['robots', 'stations']) $(`own-${what}`).value = settings[what] || '';
    for (const what of ['minutes', 'seeds']) $(`own-${what}`).value = settings[what];
    $('own-day').value = dayOf(settings);
    for (const role of Object.keys(this.about.policies)) choose($(`policy-${role}`), settings.policies[role] ?? '');
    for (const role of Object.keys(this.about.policies)) if (!settings.policies[role]) $(`policy-${role}`).value = '';
  }

  fillFiles(chosen = $('own-file').value) {
    const files = this.about.orders.filter((name) => fitsOrders($('own-orders').value, name));
    $('own-file').replaceChildren(...files.map((name) => option(name)));
    if (!chosen || fitsOrders($('own-orders').value, chosen)) choose($('own-file'), chosen);
  }

  /** A new scenario is called as its layout, until a person says otherwise. */
  renameAlike() {
    if (!this.old && $('own-name').value === this.alike) $('own-name').value = freeName(layoutOf($('own-layout').value), this.taken);
    this.changed();
  }

  settings() {
    const day = $('own-day').value;
    return {
      layout: $('own-layout').value,
      robots: count('robots'),
      stations: count('stations'),
      orders: ordersText({ kind: $('own-orders').value, rate: count('rate'), lines: count('lines'), pieces: count('pieces'), file: $('own-file').value, times: count('times') || 1 }),
      minutes: count('minutes'),
      seeds: count('seeds'),
      physics: day !== '',
      realism: day === 'ideal' ? '' : day,
      policies: policiesOf(this.about),
      events: eventsOf($('own-events').value),
    };
  }

  changed() {
    const kind = $('own-orders').value;
    for (const what of ['rate', 'lines', 'pieces']) $(`${what}-label`).hidden = kind !== 'mix';
    $('file-label').hidden = !OF_FILES.includes(kind);
    $('times-label').hidden = kind !== 'day' && kind !== 'demand';
    this.alike = freeName(layoutOf($('own-layout').value), this.taken);
    hintCounts(this.about, $('own-layout').value, [[$('own-robots'), 'robots'], [$('own-stations'), 'stations']]);
    const others = Object.keys(policiesOf(this.about)).length;
    const events = eventsOf($('own-events').value).length;
    $('events-told').textContent = events ? plural(events, '{n} event', '{n} events') : tr`none`;
    $('policies-told').textContent = others ? tr`${others} not as usual` : tr`as usual`;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.estimate(), PAUSE);
  }

  /** Asks the server whether that can run, and for how long. */
  async estimate() {
    this.asked += 1;
    const turn = this.asked, fault = faultOf(this.dialog);
    if (fault) {
      this.say(fault, 'refused');
      return;
    }
    try {
      const { seconds, robots, stations } = await ask('POST', '/estimate', { settings: this.settings() });
      const lost = this.hasRuns ? tr` Its runs are discarded where they are not of the scenario as it is then.` : '';
      if (turn === this.asked) this.say(tr`${robotsOf(robots)}, ${plural(stations, '{n} picking station', '{n} picking stations')}; it takes about ${duration(seconds)} here.${lost}`, '');
    } catch (error) {
      if (turn === this.asked) this.say(refusalOf(error.message), 'refused');
    }
  }

  say(text, kind) {
    $('editor-told').textContent = text;
    $('editor-told').dataset.kind = kind;
  }

  async send(runs) {
    const fault = faultOf(this.dialog);
    if (fault) {
      this.say(fault, 'refused');
      goToFault(this.dialog);
      return;
    }
    try {
      await this.keep($('own-name').value, this.settings(), runs, this.old);
      this.dialog.close();
    } catch (error) {
      clearTimeout(this.timer);
      this.asked += 1;
      this.say(refusalOf(error.message), 'refused');
    }
  }
}
