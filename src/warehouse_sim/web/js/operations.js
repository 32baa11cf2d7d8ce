// SPDX-License-Identifier: Apache-2.0
// The work of the warehouse: figures, stations, orders, stock; and a station's screen for a person.

import { get, post, put, remove } from './api.js';
import { $, make, on } from './dom.js';

const PERIOD = 1000; // [ms]
const KEPT = 3600; // simulated [s] of the chart
const ROWS = 50;
const FIGURES = [
  ['item_throughput_per_hour', 'pieces an hour', (v) => Math.round(v).toLocaleString('en')],
  ['item_score', 'of the upper bound', percent],
  ['orders_completed', 'orders complete', String],
  ['orders_waiting', 'orders waiting', String],
  ['late_orders_fraction', 'late', percent],
  ['pile_on', 'pieces a unit', (v) => v.toFixed(1)],
  ['station_idle_fraction', 'picking idle', percent],
  ['stock_level', 'stock', percent],
  ['collisions', 'collisions', String],
];

const history = []; // of {time, pieces}
let screen = ''; // the station whose screen is shown

function percent(value) {
  return `${Math.round(100 * value)} %`;
}

/** Does it, shows what the answer was if it was no, and looks anew. */
async function act(sent) {
  try {
    await sent;
    await look();
  } catch (error) {
    $('link').textContent = error.message;
  }
}

function showFigures(kpis) {
  $('figures').replaceChildren(...FIGURES.map(([name, words, told]) =>
    make('div', {}, make('b', { textContent: told(kpis[name]) }), make('span', { className: 'dim', textContent: words }))));
  const last = history.at(-1);
  if (!last || kpis.simulated_s > last.time) history.push({ time: kpis.simulated_s, pieces: kpis.items_picked });
  else if (kpis.simulated_s < last.time) history.length = 0;
  while (history.length && history[0].time < kpis.simulated_s - KEPT) history.shift();
  draw(kpis.item_upper_bound_per_hour);
}

function draw(bound) {
  const points = history.slice(1).map(({ time, pieces }, i) => {
    const before = history[Math.max(0, i - 5)]; // over a minute
    return [time, 3600 * (pieces - before.pieces) / (time - before.time)];
  });
  const top = Math.max(bound, ...points.map(([, rate]) => rate), 1) * 1.1;
  const begin = points[0]?.[0] ?? 0;
  const span = Math.max((points.at(-1)?.[0] ?? 1) - begin, 60);
  const at = ([time, rate]) => `${(600 * (time - begin) / span).toFixed(1)},${(120 - 120 * rate / top).toFixed(1)}`;
  const y = (120 - 120 * bound / top).toFixed(1);
  $('chart').innerHTML = `<line x1="0" x2="600" y1="${y}" y2="${y}"/><polyline points="${points.map(at).join(' ')}"/>`;
}

function showStations(stations) {
  $('stations').replaceChildren(...stations.map(card));
  const shown = stations.find(({ name, mode }) => name === screen && mode === 'MANUAL');
  $('work').hidden = !shown;
  if (shown) showScreen(shown);
}

function card(one) {
  const set = (open, mode) => act(put(`/stations/${one.name}`, { open, mode }));
  const byHand = one.mode === 'MANUAL';
  const gate = make('button', { textContent: one.open ? 'Close' : 'Open', click: () => set(!one.open, one.mode) });
  const hand = make('button', { textContent: byHand ? 'Automatic' : 'By hand' });
  on(hand, 'click', () => {
    screen = byHand ? '' : one.name;
    set(one.open, byHand ? 'AUTOMATIC' : 'MANUAL');
  });
  const work = one.kind === 'PICK' ? `${one.orders.length} of ${one.slots} orders` : 'new stock';
  const buttons = make('footer', {}, gate, hand);
  if (byHand) buttons.append(make('button', { textContent: 'Screen', click: () => { screen = one.name; } }));
  return make('div', { className: one.open ? 'station' : 'station shut' },
    make('header', {}, make('strong', { textContent: one.name }), make('span', { textContent: percent(one.busy_fraction) })),
    make('div', { className: 'dim', textContent: `${work}, ${one.pieces} pieces` }),
    make('div', { textContent: one.shelf_id ? `unit ${one.shelf_id}, ${one.inbound.length} on the way` : `${one.inbound.length} on the way` }),
    buttons);
}

/** What is to be done with the unit that is there, big enough for a finger. */
function showScreen(station) {
  const [task] = station.picks;
  const key = JSON.stringify([station.name, station.shelf_id, task]);
  if ($('work').dataset.task === key) return; // a finger may be on its way to a button
  $('work').dataset.task = key;
  if (!task) {
    $('work').replaceChildren(make('h2', { textContent: station.name }),
      make('p', { textContent: station.inbound.length ? 'The next unit is on its way.' : 'Nothing to be done.' }));
    return;
  }
  const { sku, quantity, item, reference } = task;
  const verb = station.kind === 'PICK' ? 'Take' : 'Put in';
  const button = (text, path, body) => make('button', {
    textContent: text, click: () => act(post(`/stations/${station.name}/${path}`, body)),
  });
  const buttons = make('div', { className: 'buttons' }, button('Confirm', 'confirm', { sku, quantity }));
  if (station.kind === 'PICK') {
    buttons.append(button('Short', 'short', { sku, quantity, damaged: false }),
      button('Damaged', 'short', { sku, quantity, damaged: true }));
  }
  $('work').replaceChildren(
    make('h2', { textContent: `${station.name}: storage unit ${station.shelf_id}` }),
    make('p', { className: 'task', textContent: `${verb} ${quantity} × ${sku}` }),
    make('p', { textContent: reference ? `bin ${item}, for ${reference}` : `bin ${item}` }), buttons);
}

function row(order) {
  const cancel = make('button', { textContent: 'Cancel', click: () => act(remove(`/orders/${order.order_id}`)) });
  const lines = order.lines.map(({ sku, quantity, picked }) => `${picked}/${quantity} ${sku}`).join(', ');
  const over = order.state === 'COMPLETED' || order.state === 'CANCELLED';
  return make('tr', {}, ...[order.reference, order.state, order.station, lines].map((text) => make('td', { textContent: text })),
    make('td', {}, ...over ? [] : [cancel]));
}

async function showOrders() {
  const query = new URLSearchParams({ limit: ROWS });
  if ($('search').value) query.set('search', $('search').value);
  if ($('state').value) query.set('state', $('state').value);
  const { total, orders } = await get(`/orders?${query}`);
  $('total').textContent = `${total} orders`;
  $('orders').replaceChildren(...orders.map(row));
}

async function look() {
  const [kpis, { stations }] = await Promise.all([get('/kpis'), get('/stations'), showOrders()]);
  showFigures(kpis);
  showStations(stations);
  $('link').textContent = '';
}

async function watch() {
  try {
    if (!document.hidden) await look();
  } catch (error) {
    $('link').textContent = error.message;
  }
  setTimeout(watch, PERIOD);
}

on($('find'), 'submit', (event) => event.preventDefault());
on($('where'), 'submit', async (event) => {
  event.preventDefault();
  try {
    const { total, pieces, places } = await get(`/stock?limit=${ROWS}&sku=${encodeURIComponent($('sku').value)}`);
    $('found').textContent = `${pieces} pieces in ${total} bins`;
    $('places').replaceChildren(...places.map(({ item, shelf_id: unit, quantity, reserved }) =>
      make('li', { textContent: `storage unit ${unit}: ${quantity} in ${item}${reserved ? `, ${reserved} promised` : ''}` })));
  } catch (error) {
    $('found').textContent = error.message;
  }
});
watch();
