// SPDX-License-Identifier: Apache-2.0
// Closes a zone of the floor: a rectangle drawn with the mouse or a finger, or its corners typed; for how
// long, and why. Lists the zones that are closed, each with what waits for it, and opens them.

import { get, post, remove } from '../base/api.js';
import { $, make, on, press, setText } from '../base/dom.js';
import { personOf } from '../base/person.js';
import { tr } from '../language/texts.js';
import { lasting } from '../base/time.js';

const CHECK = 300; // after the last change, until the server is asked what would wait [ms]
const CORNERS = ['x1', 'y1', 'x2', 'y2'];
const DURATIONS = [[300, tr`5 min`], [900, tr`15 min`], [3600, tr`1 h`], [14400, tr`4 h`], [0, tr`until it is opened`]];

const corner = (i, legend, x, y) => `<fieldset><legend>${legend}</legend>
  <label>x <input id="zone-x${i}" type="number" step="any" required aria-label="${x}"></label>
  <label>y <input id="zone-y${i}" type="number" step="any" required aria-label="${y}"></label></fieldset>`;

const FORM = `<header><h2 id="zone-title">${tr`Close a zone`}</h2><button type="button" id="zone-close" class="plain" title="${tr`Close this panel (Esc)`}"><svg aria-hidden="true"><use href="/web/icons.svg#close"/></svg></button></header>
<form id="zone-form" novalidate>
  <p class="dim hint">${tr`Drag over the floor, or type two corners. The fleet's robots keep out, and those inside leave.`}</p>
  <div class="zone-corners">${corner(1, tr`One corner`, tr`x of one corner [m]`, tr`y of one corner [m]`)}
    ${corner(2, tr`Opposite corner`, tr`x of the opposite corner [m]`, tr`y of the opposite corner [m]`)}</div>
  <label>${tr`For`} <select id="zone-duration">${DURATIONS.map(([s, text]) => `<option value="${s}">${text}</option>`).join('')}</select></label>
  <label>${tr`Why`} <input id="zone-reason" maxlength="60" required placeholder="${tr`spill`}" autocomplete="off"></label>
  <ul id="zone-waits" class="zone-waits" aria-live="polite"></ul>
  <button id="zone-yes" class="strong wide">${tr`Close the zone`}</button>
  <p id="zone-answer" class="answer" role="alert" data-kind="refused" hidden></p>
</form>
<h3 id="zone-list-title" hidden>${tr`Closed now`}</h3><ul id="zone-list" class="zone-list"></ul>`;

/** The edges {x_min, …} of the cells from one grid point [x, y] to another. */
export function rectangleOf([x1, y1], [x2, y2], grid) {
  const half = grid / 2;
  return { x_min: Math.min(x1, x2) - half, x_max: Math.max(x1, x2) + half,
    y_min: Math.min(y1, y2) - half, y_max: Math.max(y1, y2) + half };
}

export class ZoneTool {
  /** `page` has world, stage, pointer, tip, zones (a ZoneLayer, or null where nothing is drawn). */
  constructor(page) {
    Object.assign(this, { page, zones: [], rows: new Map(), drag: null });
    document.head.append(make('link', { rel: 'stylesheet', href: '/web/zones.css' }));
    this.panel = make('section', { id: 'zone-panel', className: 'zone-panel panel', hidden: true, innerHTML: FORM });
    this.panel.setAttribute('aria-labelledby', 'zone-title');
    $('view-panel').after(this.panel);
    on($('zone-close'), 'click', () => this.want(false));
    on($('zone-form'), 'input', () => this.changed());
    on($('zone-form'), 'submit', (event) => {
      event.preventDefault();
      this.close();
    });
    on(this.panel, 'keydown', ({ key }) => key === 'Escape' && this.want(false));
    // Before the picture's own pointer and camera.
    window.addEventListener('pointerdown', (event) => this.down(event), true);
    window.addEventListener('pointermove', (event) => this.move(event), true);
    window.addEventListener('pointerup', (event) => this.up(event), true);
    window.addEventListener('pointercancel', (event) => this.up(event), true);
  }

  get isOn() {
    return !this.panel.hidden;
  }

  want(isOn) {
    press($('zone'), isOn);
    this.panel.hidden = !isOn;
    this.stop();
    this.sketch();
    if (isOn) {
      this.list();
      this.page.tip.say(tr`drag over the floor to draw a zone, or type its corners; Esc ends it`, 'sent');
    } else {
      $('zone').focus();
    }
    $('stage').style.cursor = isOn ? 'crosshair' : '';
  }

  // --- drawing

  down(event) {
    if (!this.isOn || event.target !== $('stage') || event.button !== 0) return;
    if (!event.isPrimary) { // a second finger moves the picture
      this.stop();
      return;
    }
    const cell = this.page.pointer?.cellAt(event.clientX, event.clientY);
    if (!cell) return;
    event.stopPropagation();
    this.drag = cell;
    this.hold(true);
    this.fill(cell, cell);
  }

  move(event) {
    if (!this.drag) return;
    event.stopPropagation();
    const cell = this.page.pointer.cellAt(event.clientX, event.clientY);
    if (cell) this.fill(this.drag, cell);
  }

  up(event) {
    if (!this.drag) return;
    event.stopPropagation();
    this.stop();
    $('zone-reason').focus();
  }

  stop() {
    if (this.drag) this.hold(false);
    this.drag = null;
  }

  /** Keeps the camera still while a zone is drawn. */
  hold(isHeld) {
    const { controls, isAbove } = this.page.stage;
    controls.enablePan = !isHeld;
    controls.enableRotate = !isHeld && !isAbove;
  }

  fill(from, to) {
    [...from, ...to].forEach((value, i) => { $(`zone-${CORNERS[i]}`).value = value; });
    this.changed();
  }

  // --- what is typed or drawn

  /** [x1, y1, x2, y2] of the form; null: some are missing. */
  get corners() {
    const numbers = CORNERS.map((name) => $(`zone-${name}`).valueAsNumber);
    return numbers.every(Number.isFinite) ? numbers : null;
  }

  changed() {
    this.answer('');
    this.sketch();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.check(), CHECK);
  }

  sketch() {
    const { corners } = this, { grid = 1 } = this.page.world.scene;
    const snap = (value) => Math.round(value / grid) * grid;
    const [x1, y1, x2, y2] = (corners ?? []).map(snap);
    this.page.zones?.sketch(this.isOn && corners ? rectangleOf([x1, y1], [x2, y2], grid) : null);
  }

  /** Shows what would wait. */
  async check() {
    const { corners } = this;
    if (!corners) return;
    const query = CORNERS.map((name, i) => `${name}=${corners[i]}`).join('&');
    try {
      const { waits } = await get(`/zones/check?${query}`);
      if (String(corners) === String(this.corners)) this.showWaits(waits);
    } catch (error) {
      this.showWaits([]);
      this.answer(error.message);
    }
  }

  showWaits(waits) {
    const lines = waits.length ? waits : [tr`nothing waits: all goes on around it`];
    $('zone-waits').replaceChildren(...lines.map((text) => make('li', { textContent: text, className: waits.length ? 'is-held' : 'dim' })));
  }

  async close() {
    const { corners } = this, reason = $('zone-reason').value.trim();
    const lack = corners ? reason ? '' : tr`why is it closed? One word is enough, as: spill` : tr`draw the zone, or type two corners`;
    if (lack) {
      this.answer(lack);
      $(corners ? 'zone-reason' : 'zone-x1').focus();
      return;
    }
    const by = await personOf();
    const [x1, y1, x2, y2] = corners;
    const body = { x1, y1, x2, y2, duration: Number($('zone-duration').value), reason, by };
    $('zone-yes').disabled = true;
    try {
      await post('/zones', body);
      this.page.tip.say(tr`zone '${reason}' is closed`, 'done');
      for (const name of CORNERS) $(`zone-${name}`).value = '';
      $('zone-reason').value = '';
      $('zone-waits').replaceChildren();
      this.sketch();
    } catch (error) {
      this.answer(error.message);
    }
    $('zone-yes').disabled = false;
  }

  answer(text) {
    Object.assign($('zone-answer'), { hidden: !text, textContent: text });
  }

  // --- what is closed

  /** The zones of the server. */
  take(zones) {
    this.zones = zones;
    if (this.isOn) this.list();
  }

  /** Rows stay as long as they say the same, so that their buttons can be pressed. */
  list() {
    const rows = this.zones.map((zone) => {
      const said = JSON.stringify([zone.reason, zone.closed_by, zone.inside, zone.waits]);
      const known = this.rows.get(zone.id);
      return [zone.id, known?.said === said ? known : { said, ...this.row(zone) }];
    });
    const isSame = rows.length === this.rows.size && rows.every(([id, row]) => this.rows.get(id) === row);
    this.rows = new Map(rows);
    this.zones.forEach(({ id, until }) => setText(this.rows.get(id).left,
      until === null ? tr`until it is opened` : tr`${lasting(until - this.page.world.stamp)} left`));
    if (isSame) return;
    $('zone-list').replaceChildren(...rows.map(([, { item }]) => item));
    $('zone-list-title').hidden = !rows.length;
  }

  row(zone) {
    const left = make('span', { className: 'dim' }), by = zone.closed_by ? [tr`closed by ${zone.closed_by}`] : [];
    const inside = zone.inside.length ? [tr`inside: ${zone.inside.join(', ')}`] : [];
    const lines = [...by, ...inside].map((text) => make('span', { className: 'dim', textContent: text }));
    const button = make('button', { className: 'edged', textContent: tr`Open`, title: tr`Open the zone '${zone.reason}' now`, click: () => this.open(zone) });
    return { left, item: make('li', {}, make('b', { textContent: zone.reason }), left, ...lines,
      ...zone.waits.map((text) => make('span', { textContent: text })), button) };
  }

  async open({ id, reason }) {
    try {
      await personOf();
      await remove(`/zones/${id}`);
      this.page.tip.say(tr`zone '${reason}' is open again`, 'done');
    } catch (error) {
      this.answer(error.message);
    }
  }
}
