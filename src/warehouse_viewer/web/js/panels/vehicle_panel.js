// SPDX-License-Identifier: Apache-2.0
// Vehicles of other makers: which are at the broker, what each can and what does not fit, and the form by
// which one is placed on the floor, numbered, and becomes a robot. Also removes them.

import { get, post, remove } from '../base/api.js';
import { $, make, on } from '../base/dom.js';
import { personOf } from '../base/person.js';
import { confirmed } from '../base/question.js';
import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';

const PERIOD = 2000; // between two questions while it is open [ms]
const CONNECTION = { ONLINE: tr`online`, OFFLINE: tr`offline`, CONNECTIONBROKEN: tr`connection broken` };

const field = (id, label, more) => `<label data-field="${id}">${label} <input id="vehicle-${id}" ${more}></label>`;

const FORM = `<header><h2 id="vehicle-title">${tr`Vehicles at the broker`}</h2><button type="button" id="vehicle-close" class="plain" title="${tr`Close this panel (Esc)`}"><svg aria-hidden="true"><use href="/web/icons.svg#close"/></svg></button></header>
<ul id="vehicle-list" class="zone-list"></ul>
<form id="vehicle-form" novalidate hidden>
  <h3 id="vehicle-name"></h3>
  <ul id="vehicle-abilities" class="zone-waits"></ul>
  <ul id="vehicle-misfits" class="zone-waits"></ul>
  <p class="dim hint">${tr`Put it in the middle of a cell. Click that cell, or type where it is.`}</p>
  <label>${tr`Place`} <select id="vehicle-place"><option value="STANDS">${tr`where it stands now`}</option><option value="ORIGIN">${tr`zero point of its map`}</option></select></label>
  ${field('x', tr`x [m]`, 'type="number" step="any"')}${field('y', tr`y [m]`, 'type="number" step="any"')}
  ${field('heading', tr`Heading [°]`, 'type="number" step="any" value="0"')}
  ${field('number', tr`Number`, `type="number" min="1" step="1" placeholder="${tr`lowest free`}"`)}
  <details><summary>${tr`Names and parameters`}</summary>
    ${field('map', tr`Map id`, `autocomplete="off" placeholder="${tr`as it reports`}"`)}${field('nodes', tr`Node ids`, 'autocomplete="off" placeholder="c{column}_{row}"')}
    ${field('parameters', tr`Action parameters`, `autocomplete="off" placeholder='{"loadType": "EPAL"}'`)}</details>
  <label id="vehicle-assume-label" class="vehicle-assume"><input id="vehicle-assume" type="checkbox"> ${tr`Go on without a factsheet`}</label>
  <button id="vehicle-yes" class="strong wide">${tr`Add it as a robot`}</button>
</form>
<p id="vehicle-answer" class="answer" role="alert" hidden></p>`;

/** A vehicle in a line: connection, mode, and where it says to be. */
export function lineOf({ connection, mode, position, map_id: map }) {
  const at = position ? tr`at ${number(position[0], 2)}, ${number(position[1], 2)} m${map ? tr` on map '${map}'` : ''}` : tr`it has not said where it is`;
  return [CONNECTION[connection], mode, at].filter(Boolean).join(', ');
}

export class VehiclePanel {
  constructor(tool) {
    Object.assign(this, { tool, vehicles: [], chosen: null });
    if (!document.querySelector('link[href="/web/zones.css"]')) {
      document.head.append(make('link', { rel: 'stylesheet', href: '/web/zones.css' }));
    }
    this.panel = make('section', { id: 'vehicle-panel', className: 'zone-panel panel', hidden: true, innerHTML: FORM });
    this.panel.setAttribute('aria-labelledby', 'vehicle-title');
    $('view-panel').after(this.panel);
    on($('vehicle-close'), 'click', () => tool.open(false));
    on($('vehicle-form'), 'submit', (event) => {
      event.preventDefault();
      this.add();
    });
    on(this.panel, 'keydown', ({ key }) => key === 'Escape' && tool.open(false));
  }

  get wantsCell() {
    return !this.panel.hidden && this.chosen !== null;
  }

  want(isOn) {
    this.panel.hidden = !isOn;
    clearInterval(this.timer);
    this.choose(null);
    if (!isOn) {
      $('add-vehicle').focus();
      return;
    }
    this.answer('');
    this.refresh();
    this.timer = setInterval(() => this.refresh(), PERIOD);
  }

  async refresh() {
    try {
      const { vehicles } = await get('/vda5050/vehicles');
      this.take(vehicles);
    } catch (error) {
      this.answer(error.message);
    }
  }

  /** Rows stay as long as they say the same, so that their buttons can be pressed. */
  take(vehicles) {
    const said = JSON.stringify(vehicles.map((vehicle) => [vehicle.id, nameOf(vehicle), lineOf(vehicle)]));
    this.vehicles = vehicles;
    if (this.chosen) this.showFactsheet();
    if (said === this.said) return;
    this.said = said;
    const rows = vehicles.map((vehicle) => this.row(vehicle));
    const none = make('li', { className: 'dim', textContent: tr`None has been seen yet.` });
    $('vehicle-list').replaceChildren(...rows.length ? rows : [none]);
  }

  row(vehicle) {
    const name = nameOf(vehicle), isOurs = vehicle.id !== null;
    const button = isOurs
      ? make('button', { className: 'edged', textContent: tr`Remove`, title: tr`Lets ${name} be no robot here any more`, click: () => this.remove(vehicle) })
      : make('button', { className: 'edged', textContent: tr`Add…`, title: tr`Place ${name} on the floor`, click: () => this.choose(name) });
    const title = isOurs ? tr`${name}: kiva${vehicle.id}` : name;
    return make('li', {}, make('b', { textContent: title }), make('span', { className: 'dim', textContent: lineOf(vehicle) }), button);
  }

  /** Opens the form for the vehicle of that name; null: closes it. */
  choose(name) {
    this.chosen = name;
    $('vehicle-form').hidden = name === null;
    this.tool.changed(); // the page lights the free cells
    if (name === null) return;
    this.answer('');
    $('vehicle-name').textContent = name;
    $('vehicle-assume').checked = false;
    this.showFactsheet();
    $('vehicle-x').focus();
    this.tool.page.tip.say(tr`click the cell where ${name} stands; Esc ends it`, 'sent');
  }

  get vehicle() {
    return this.vehicles.find((vehicle) => nameOf(vehicle) === this.chosen);
  }

  showFactsheet() {
    const { abilities = [], misfits = [], factsheet = false } = this.vehicle ?? {};
    $('vehicle-abilities').replaceChildren(...lines(abilities, ''));
    $('vehicle-misfits').replaceChildren(...lines(misfits.length ? misfits : [tr`All of it fits.`], misfits.length ? 'is-held' : 'dim'));
    $('vehicle-assume-label').hidden = factsheet;
  }

  /** The cell that was clicked. */
  place([x, y]) {
    $('vehicle-place').value = 'STANDS';
    Object.assign($('vehicle-x'), { value: x });
    Object.assign($('vehicle-y'), { value: y });
    $('vehicle-heading').focus();
  }

  async add() {
    const { vehicle } = this;
    const [x, y, heading, id] = ['x', 'y', 'heading', 'number'].map((name) => $(`vehicle-${name}`).valueAsNumber);
    if (![x, y, heading].every(Number.isFinite)) {
      this.answer(tr`click the cell where it stands, or type x, y and heading`);
      return;
    }
    const body = { by: await personOf(), manufacturer: vehicle.manufacturer, serial: vehicle.serial,
      id: id || 0, place: $('vehicle-place').value,
      x, y, heading: heading * Math.PI / 180, map_id: $('vehicle-map').value.trim(), node_ids: $('vehicle-nodes').value.trim(),
      action_parameters: $('vehicle-parameters').value.trim(), assume: $('vehicle-assume').checked };
    $('vehicle-yes').disabled = true;
    try {
      const { message } = await post('/vda5050/vehicles', body);
      this.choose(null);
      this.answer(message, 'done');
      await this.refresh();
    } catch (error) {
      this.answer(error.message);
    }
    $('vehicle-yes').disabled = false;
  }

  async remove(vehicle) {
    const name = nameOf(vehicle);
    if (!await confirmed(tr`Remove kiva${vehicle.id}?`, tr`${name} is no robot of this warehouse then; it stays at the broker.`, tr`Remove`)) return;
    try {
      const { message } = await remove(`/vda5050/vehicles/${vehicle.id}`);
      this.answer(message, 'done');
    } catch (error) {
      this.answer(error.message);
    }
    await this.refresh();
  }

  answer(text, kind = 'refused') {
    Object.assign($('vehicle-answer'), { hidden: !text, textContent: text });
    $('vehicle-answer').dataset.kind = kind;
  }
}

const lines = (texts, className) => texts.map((textContent) => make('li', { textContent, className }));
const nameOf = ({ manufacturer, serial }) => `${manufacturer}/${serial}`;
