// SPDX-License-Identifier: Apache-2.0
// The work of the warehouse: figures, robots, stations, orders, stock. What changes comes by itself.

import { Alarms } from './alarms.js';
import { get, remove } from './api.js';
import { Changes } from './changes.js';
import { draw } from './chart.js';
import { $, make, on } from './dom.js';
import { OrderList } from './order_list.js';
import { piecesOf } from './order_row.js';
import { confirmed } from './question.js';
import { Stations, waitingOf } from './stations.js';
import { spaced } from './words.js';

const PLACES = 200;
const FIGURES = [
  ['item_throughput_per_hour', 'pieces per hour', count],
  ['item_score', 'throughput / upper bound', percent],
  ['orders_completed', 'orders completed', count],
  ['orders_waiting', 'orders waiting', count],
  ['orders_at_stations', 'at stations', count],
  ['orders_late', 'late now', count],
  ['late_orders_fraction', 'late, of all orders', percent],
  ['pile_on', 'pieces per unit visit', (v) => v.toFixed(1)],
  ['station_idle_fraction', 'picking stations idle', percent],
  ['stock_level', 'stock', percent],
  ['real_time_factor', 'real-time factor', (v) => v.toFixed(2)],
  ['collisions', 'collisions', count],
];
// Of the palette of Okabe and Ito (2008), light to dark within what belongs together.
const WORK_COLOURS = { fetching: '#56b4e9', ready: '#a6d8f5', lifting: '#0072b2', bringing: '#009e73', waiting: '#f0e442', storing: '#66c2a5',
  dropping: '#005c8f', idle: '#9aa4b1', manual: '#cc79a7', out_of_service: '#d55e00' };

function count(value) {
  return Math.round(value).toLocaleString('en');
}

function percent(value) {
  return `${Math.round(100 * value)} %`;
}

class Page {
  constructor() {
    this.kpis = this.throughput = null;
    this.stations = new Stations((sent) => this.act(sent));
    this.alarms = new Alarms();
    this.orders = new OrderList((order) => this.cancel(order), (error) => this.say(error.message));
    on(window, 'hashchange', leaveForStation);
    leaveForStation();
    on($('where'), 'submit', (event) => {
      event.preventDefault();
      this.where();
    });
    this.changes = new Changes(['orders', 'stations', 'kpis', 'throughput', 'coordinator', 'notices'], {
      state: (live) => this.showLink(live ? 'live' : 'away'),
      shift: ({ runs }) => this.takeShift(runs),
      stations: ({ stations }) => {
        this.stations.take(stations);
        this.alarms.set('stations', stations.filter(waitingOf).map((one) => `${one.name} ${waitingOf(one)}`));
      },
      kpis: ({ kpis }) => {
        this.kpis = kpis;
        this.showFigures();
        this.showChart();
      },
      throughput: ({ throughput }) => {
        this.throughput = throughput;
        this.showChart();
      },
      orders: (message) => this.orders.take(message),
      coordinator: ({ coordinator }) => this.showFleet(coordinator),
      notices: ({ notices }) => this.alarms.set('orders', notices),
    });
  }

  takeShift(runs) {
    this.showLink(runs ? 'live' : 'idle');
    if (runs) this.orders.begin();
  }

  showLink(state) {
    $('link').dataset.state = state;
    const text = { live: 'live', away: 'the server does not answer', idle: 'no shift is running (operations.launch)' }[state];
    $('link').textContent = text;
  }

  /** Waits for what was asked of the server, and says what became of it: `told(message)`, or why
   *  the answer was no. */
  async act(sent, told = () => '') {
    this.say('');
    try {
      const { message } = await sent;
      this.say(told(message), 'done');
    } catch (error) {
      this.say(error.message);
    }
  }

  /** Asks first: an order that is cancelled does not come back. */
  async cancel(order) {
    const { order_id: id, reference, station } = order;
    const at = station ? ` It is at ${station}.` : '';
    const title = `Cancel ${reference}?`;
    if (!await confirmed(title, `Order ${id}, picked so far: ${piecesOf(order)}.${at}`, `Cancel ${reference}`, 'Keep it')) return;
    await this.act(remove(`/orders/${id}`), (message) => [`${reference} is cancelled`, message].filter(Boolean).join('; '));
  }

  say(text, kind = 'refused') {
    Object.assign($('answer'), { hidden: !text, textContent: text });
    $('answer').dataset.kind = kind;
  }

  showFigures() {
    $('figures').replaceChildren(...FIGURES.map(([name, text, told]) => (
      make('div', {}, make('b', { textContent: told(this.kpis[name]) }), make('span', { className: 'dim', textContent: text })))));
  }

  showChart() {
    if (this.kpis && this.throughput) draw(this.throughput, this.kpis.item_upper_bound_per_hour);
  }

  // --- robots
  showFleet(fleet) {
    $('fleet').textContent = fleet ? '' : 'no coordinator runs';
    this.alarms.set('coordinator', fleet?.alarms ?? []);
    if (!fleet) return;
    this.orders.now = fleet.time;
    $('time').textContent = clock(fleet.time);
    const { manual, out_of_service } = fleet.robots;
    const doing = { ...fleet.work, manual, out_of_service };
    const shown = Object.entries(WORK_COLOURS).filter(([name]) => doing[name]);
    $('robots').replaceChildren(...shown.map(([name, colour]) => {
      const bar = make('div', { title: `${doing[name]} ${spaced(name)}` });
      Object.assign(bar.style, { flex: doing[name], background: colour });
      return bar;
    }));
    $('robots-legend').replaceChildren(...shown.map(([name, colour]) => {
      const dot = make('i');
      dot.style.background = colour;
      return make('li', {}, dot, make('b', { textContent: doing[name] }), ` ${spaced(name)}`);
    }));
    const { transports } = fleet;
    $('fleet').textContent = `${transports.under_way} transports under way, ${transports.open} open; planning takes `
      + `${fleet.plan_p50.toFixed(1)} ms, p99 ${fleet.plan_p99.toFixed(1)} ms`;
    $('waiting').replaceChildren(...fleet.waiting.map(({ robot, since, text }) => (
      make('li', { textContent: `kiva${robot} waits ${Math.round(fleet.time - since)} s ${text}` }))));
  }

  // --- stock
  async where() {
    const sku = $('sku').value.trim();
    try {
      const { total, pieces, places } = await get(`/stock?limit=${PLACES}&sku=${encodeURIComponent(sku)}`);
      $('found').textContent = `${count(pieces)} pieces in ${count(total)} bins`;
      Object.assign($('on-floor'), { hidden: !sku || !total, href: `/#${encodeURIComponent(sku)}` });
      $('places').replaceChildren(...places.map(({ item, shelf_id: unit, sku: held, quantity, reserved }) => (
        make('li', { textContent: `storage unit ${unit}: ${quantity}${sku ? '' : ` ${held}`} in ${item}${reserved ? `, ${reserved} reserved` : ''}` }))));
    } catch (error) {
      $('found').textContent = error.message;
    }
  }
}

/** A link of old, /operations#pick1, leads to that station's screen. */
function leaveForStation() {
  if (location.hash.length > 1) location.replace(`/station/${location.hash.slice(1)}`);
}

const pad = (n) => String(Math.floor(n)).padStart(2, '0');

function clock(seconds) {
  return `${Math.floor(seconds / 3600)}:${pad(seconds / 60 % 60)}:${pad(seconds % 60)}`;
}

window.page = new Page(); // for a look from the console
