// SPDX-License-Identifier: Apache-2.0
// The work of the warehouse: figures, alarms, stations, robots, orders, stock. What
// changes comes by itself.

import { ROOT } from '../base/root.js';
import { tr } from '../language/texts.js';
import { Alarms } from './alarms.js';
import { get, remove } from '../base/api.js';
import { Changes } from '../base/changes.js';
import { $, make, on } from '../base/dom.js';
import { count, Figures } from './figures.js';
import { ForecastCard } from './forecast.js';
import { Gantt } from './gantt.js';
import { completeSkus, OrderEntry } from './order_entry.js';
import { OrderList } from './order_list.js';
import { OrderUpload } from './order_upload.js';
import { piecesOf } from './order_row.js';
import { confirmed } from '../base/question.js';
import { RobotShares } from './robot_shares.js';
import { Stations } from './stations.js';
import { ThroughputChart } from './throughput.js';
import { clock } from '../base/time.js';

const PLACES = 200;
const TOPICS = ['orders', 'stations', 'kpis', 'throughput', 'coordinator', 'alarms', 'figures', 'forecasts'];

class Page {
  constructor() {
    this.kpis = this.throughput = null;
    this.now = 0; // [s], simulated
    const fail = (error) => this.say(error.message);
    this.stations = new Stations((sent) => this.act(sent));
    this.alarms = new Alarms(fail);
    this.figures = new Figures();
    this.chart = new ThroughputChart();
    this.forecast = new ForecastCard();
    this.shares = new RobotShares();
    this.gantt = new Gantt();
    this.orders = new OrderList((order) => this.cancel(order), fail, (order) => this.openOrder(order));
    const taken = (text) => this.taken(text);
    this.entry = new OrderEntry(() => this.now, taken);
    this.upload = new OrderUpload(taken);
    completeSkus($('sku'));
    on($('open-handover'), 'click', () => import('./handover.js').then(({ openHandover }) => openHandover()).catch(fail));
    $('batteries').addEventListener('toggle', () => import('./batteries.js').then(({ watchBatteries }) => watchBatteries()), { once: true });
    on(window, 'hashchange', leaveForStation);
    leaveForStation();
    on($('where'), 'submit', (event) => {
      event.preventDefault();
      this.where();
    });
    this.changes = new Changes(TOPICS, this.handlers());
  }

  handlers() {
    return {
      state: (live) => this.showLink(live ? 'live' : 'away'),
      shift: ({ runs }) => this.takeShift(runs),
      stations: ({ stations }) => {
        this.stations.take(stations);
        this.forecast.takeStations(stations);
      },
      kpis: ({ kpis }) => {
        this.kpis = kpis;
        this.figures.showSmall(kpis);
        this.showChart();
      },
      throughput: ({ throughput }) => {
        this.throughput = this.forecast.throughput = throughput;
        this.showChart();
      },
      forecasts: ({ forecasts: newest }) => this.forecast.take(newest),
      figures: ({ figures }) => this.figures.showLeading(figures),
      alarms: ({ alarms }) => this.alarms.take(alarms),
      orders: (message) => {
        this.orders.take(message);
        this.details?.take(message);
      },
      coordinator: ({ coordinator }) => this.showFleet(coordinator),
    };
  }

  takeShift(runs) {
    this.showLink(runs ? 'live' : 'idle');
    if (runs) this.orders.begin();
  }

  showLink(state) {
    $('link').dataset.state = state;
    const text = { live: tr`live`, away: tr`the server does not answer`, idle: tr`no shift is running (operations.launch)` }[state];
    $('link').textContent = text;
    this.alarms.setAway(state === 'away' ? text : '');
  }

  /** Waits for the server's answer and shows it: `textOf(message)`, or the reason of a refusal. */
  async act(sent, textOf = () => '') {
    this.say('');
    try {
      const { message } = await sent;
      this.say(textOf(message), 'done');
    } catch (error) {
      this.say(error.message);
    }
  }

  /** Asks first: an order that is cancelled does not come back. */
  async cancel(order) {
    const { order_id: id, reference, station } = order;
    const at = station ? tr` It is at ${station}.` : '';
    const title = tr`Cancel ${reference}?`;
    if (!await confirmed(title, tr`Order ${id}, picked so far: ${piecesOf(order)}.${at}`, tr`Cancel ${reference}`, tr`Keep it`)) return;
    await this.act(remove(`/orders/${id}`), (message) => [tr`${reference} is cancelled`, message].filter(Boolean).join('; '));
  }

  /** What has become of an order, and how urgent it is. */
  async openOrder(order) {
    const { OrderDetails } = await import('./order_details.js');
    this.details ??= new OrderDetails(() => this.now, (text) => this.taken(text));
    await this.details.open(order);
  }

  /** Orders of this page's own: they belong into the list at once. */
  taken(text) {
    this.say(text, 'done');
    this.orders.reload(0);
  }

  say(text, kind = 'refused') {
    Object.assign($('answer'), { hidden: !text, textContent: text });
    $('answer').dataset.kind = kind;
  }

  showChart() {
    if (this.kpis && this.throughput) this.chart.show(this.throughput, this.kpis.item_upper_bound_per_hour);
  }

  showFleet(fleet) {
    this.shares.show(fleet);
    if (!fleet) return;
    this.now = this.orders.now = fleet.time;
    $('time').textContent = clock(fleet.time);
    this.stations.tick(fleet.time);
    this.alarms.tick(fleet.time);
  }

  // --- stock
  async where() {
    const sku = $('sku').value.trim();
    try {
      const { total, pieces, places } = await get(`/stock?limit=${PLACES}&sku=${encodeURIComponent(sku)}`);
      $('found').textContent = tr`${count(pieces)} pieces in ${count(total)} bins`;
      Object.assign($('on-floor'), { hidden: !sku || !total, href: `${ROOT}/#${encodeURIComponent(sku)}` });
      $('places').replaceChildren(...places.map(({ item, shelf_id: unit, sku: held, quantity, reserved }) => (
        make('li', { textContent: tr`unit ${unit}: ${count(quantity)}${sku ? '' : ` ${held}`} in ${item.replace('item', 'bin ')}${reserved ? tr`, ${reserved} reserved` : ''}` }))));
    } catch (error) {
      $('found').textContent = error.message;
    }
  }
}

/** A link of old, /operations#pick1, leads to that station's screen. */
function leaveForStation() {
  if (location.hash.length > 1) location.replace(`${ROOT}/station/${location.hash.slice(1)}`);
}

window.page = new Page(); // for a look from the console
