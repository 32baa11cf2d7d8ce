// SPDX-License-Identifier: Apache-2.0
// What will come of the shift: orders done so far as a line, those to come as a band, and what a
// change would do to them.

import { get, post } from '../base/api.js';
import { axis, faint, font, Plot } from '../base/charts.js';
import { $, make, on, token } from '../base/dom.js';
import { number } from '../language/numbers.js';
import { ask } from '../base/request.js';
import { plural, tr } from '../language/texts.js';
import { clock } from '../base/time.js';

const ROBOTS = [2, 1, -1, -2];
const FIRST = 'order'; // the value of "an order first"
const HIGHEST = 255; // priority
const OWN = 'learned'; // a policy that needs a file
const ROLES = ['orders', 'units', 'bins', 'batches', 'replenishment']; // the coordinator has the others

/** When a shift had done how many orders since its last hour began: {at, sum} each, at [s]. */
function doneAt({ interval, begin, end, orders_completed: done }) {
  let sum = 0;
  const edges = done.map((count, i) => {
    const edge = { at: Math.min(Math.max(begin, (Math.floor(begin / interval) + i) * interval), end), sum };
    sum += count;
    return edge;
  });
  return [...edges, { at: end, sum }];
}

/** How many orders were done by a time, evenly between two edges; before the first of them NaN. */
function sumAt(edges, time) {
  if (time < edges[0].at) return NaN;
  const i = edges.findIndex(({ at }) => at >= time);
  if (i < 0) return edges.at(-1).sum;
  const [from, to] = [edges[Math.max(i - 1, 0)], edges[i]];
  return to.at > from.at ? from.sum + ((to.sum - from.sum) * (time - from.at)) / (to.at - from.at) : to.sum;
}

/** Points of the orders done in the last hour, counted back from `now` [s]; x in minutes from it. */
export function pastOf(throughput, now) {
  const edges = doneAt(throughput);
  const sum = sumAt(edges, now);
  if (Number.isNaN(sum)) return [];
  return [...edges.filter(({ at }) => at < now).map(({ at, sum: then }) => ({ x: (at - now) / 60, y: then - sum })), { x: 0, y: 0 }];
}

/** How many orders were done between two times [s]; NaN: it is not known. */
export function doneBetween(throughput, from, to) {
  const edges = doneAt(throughput);
  return sumAt(edges, to) - sumAt(edges, from);
}

/** Points of a quantile of the orders to be done, from now on. */
export function aheadOf({ made_at: begin, time, done }, quantile) {
  return [{ x: 0, y: 0 }, ...time.map((at, i) => ({ x: (at - begin) / 60, y: done[quantile][i] }))];
}

/** Changes that can be tried: {text, label} each; `text` as the service takes it. */
export function changesOf(stations) {
  const shut = stations.map(({ name, open }) => {
    const what = open ? 'close' : 'open';
    return { text: `+0 ${what} ${name}`, label: open ? tr`close ${name}` : tr`open ${name}` };
  });
  const robots = ROBOTS.map((n) => ({
    text: `+0 robots ${n > 0 ? '+' : ''}${n}`,
    label: n > 0 ? plural(n, '{n} robot more', '{n} robots more') : plural(-n, '{n} robot fewer', '{n} robots fewer'),
  }));
  return [...robots, ...shut];
}

/** Other policies that can be tried: {role: [{text, label}]}, without those that are the default. */
export function policiesOf({ policies, default_policies: usual }) {
  const others = (role) => policies[role].filter((name) => name !== usual[role] && name !== OWN);
  return Object.fromEntries(ROLES.map((role) => [
    role, others(role).map((name) => ({ text: `+0 policy ${role} ${name}`, label: `${role}: ${name}` })),
  ]));
}

const options = (changes) => changes.map(({ text, label }) => make('option', { value: text, textContent: label }));

export class ForecastCard {
  constructor() {
    Object.assign(this, { id: 0, asked: 0, plain: null, throughput: null, known: '', policies: [] });
    this.plot = new Plot($('chart-forecast'), look);
    on($('forecast-form'), 'submit', (event) => {
      event.preventDefault();
      this.ask();
    });
    on($('forecast-change'), 'focus', () => this.offerPolicies(), { once: true });
    on($('forecast-change'), 'change', () => this.askOrder());
  }

  async offerPolicies() {
    const about = await ask('GET', '/whatif/about').catch(() => null);
    if (about) this.policies = Object.values(policiesOf(about)).flat();
    this.known = '';
    if (this.stations) this.takeStations(this.stations);
  }

  /** An order that is to come first is named. */
  askOrder() {
    const named = $('forecast-change').value === FIRST;
    $('forecast-order').hidden = !named;
    $('forecast-order').required = named;
    if (named) $('forecast-order').focus();
  }

  /** Offers what can be changed. */
  takeStations(stations) {
    this.stations = stations;
    const changes = [...changesOf(stations), { text: FIRST, label: tr`an order first …` }];
    const known = JSON.stringify(changes);
    if (known === this.known) return;
    this.known = known;
    const chosen = $('forecast-change').value;
    $('forecast-change').replaceChildren(
      make('option', { value: '', textContent: tr`nothing` }),
      ...options(changes),
      ...this.policies.length ? [make('optgroup', { label: tr`another policy` }, ...options(this.policies))] : []);
    const all = [...changes, ...this.policies];
    $('forecast-change').value = all.some(({ text }) => text === chosen) ? chosen : '';
  }

  /** The change that is chosen, as the service takes it. */
  change() {
    const { value } = $('forecast-change');
    return value === FIRST ? `+0 priority ${$('forecast-order').value.trim()} ${HIGHEST}` : value;
  }

  async ask() {
    const change = this.change();
    this.say('', tr`looks ahead for about 20 s …`);
    try {
      const asked = { minutes: Number($('forecast-minutes').value), changes: change ? [change] : [] };
      ({ forecast_id: this.id } = await post('/forecasts', asked));
      this.asked = this.id;
      this.take(await get(`/forecasts/${this.id}`));
    } catch (error) {
      this.say(error.message, '');
    }
  }

  /** A forecast, of this page's or of another one. */
  take(forecast) {
    if (forecast.state !== 'DONE' || this.keepsOwn(forecast)) return;
    const { forecast_id: id, made_at: begin, runs, changes, text } = forecast;
    this.id = Math.max(this.id, id);
    const changed = changes.length ? tr`, with ${changes.map((line) => line.replace(/^\+0\S* /, '')).join(', ')}` : '';
    this.say(sentenceOf(text), runs ? tr`made at ${clock(begin)} from ${number(runs)} runs${changed}` : '');
    if (!runs) return;
    if (!changes.length) this.plain = forecast;
    this.shown = forecast;
    this.past = this.throughput ? pastOf(this.throughput, begin) : [];
    this.draw();
  }

  /** Whether this page's change stays in sight, since nothing was asked for since. */
  keepsOwn({ forecast_id: id, changes }) {
    return !changes.length && id !== this.asked && this.shown?.changes.length > 0 && this.shown.forecast_id === this.asked;
  }

  say(text, state) {
    Object.assign($('forecast-text'), { textContent: text, hidden: !text });
    $('forecast-state').textContent = state;
  }

  draw() {
    const { shown, past } = this;
    const before = this.pointsBefore();
    $('forecast-plot').hidden = false;
    $('forecast-other').hidden = !before.length;
    $('chart-forecast').ariaLabel = $('forecast-text').textContent;
    this.plot.show(past, aheadOf(shown, 'p90'), aheadOf(shown, 'p10'), aheadOf(shown, 'p50'), before);
  }

  /** Points of the last forecast without the change, counted from where the one shown begins. */
  pointsBefore() {
    const { shown, plain, throughput } = this;
    if (!plain || plain === shown || plain.made_at > shown.made_at || !throughput) return [];
    const late = (shown.made_at - plain.made_at) / 60;
    const done = late ? doneBetween(throughput, plain.made_at, shown.made_at) : 0;
    return Number.isNaN(done) ? [] : aheadOf(plain, 'p50').map(({ x, y }) => ({ x: x - late, y: y - done }));
  }
}

const sentenceOf = (text) => `${text[0].toUpperCase()}${text.slice(1)}.`;

/** What a point counts: the orders done since, where it lies in the past. */
export const labelOf = ({ label }, { x }) => (x < 0 ? tr`done since then` : label);

function look() {
  const line = { pointRadius: 0, borderWidth: 1.75 };
  return {
    type: 'line',
    datasets: [
      { ...line, label: tr`done`, borderColor: token('text') },
      { ...line, label: tr`nine of ten runs have at most`, borderWidth: 0, backgroundColor: faint('moving', 0.25), fill: '+1' },
      { ...line, label: tr`nine of ten runs have at least`, borderWidth: 0 },
      { ...line, label: tr`half of the runs have`, borderColor: token('moving') },
      { ...line, label: tr`without the change`, borderColor: token('dim'), borderDash: [4, 4], borderWidth: 1.25 },
    ],
    options: {
      parsing: false,
      interaction: { mode: 'nearest', axis: 'x', intersect: false },
      scales: {
        x: axis(tr`minutes from now`, { ticks: { callback: (minutes) => Math.round(minutes) }, grid: { display: false }, scale: { bounds: 'ticks' } }),
        y: axis(tr`orders done`, { ticks: { callback: (count) => number(Math.abs(count)) }, scale: { grace: '5%' } }),
      },
      plugins: {
        legend: { display: false },
        tooltip: { backgroundColor: token('raised'), titleColor: token('text'), bodyColor: token('text'), borderColor: token('line'), borderWidth: 1, titleFont: font(), bodyFont: font(),
          callbacks: { title: ([{ parsed }]) => tr`${Math.abs(Math.round(parsed.x))} min ${parsed.x < 0 ? tr`ago` : tr`from now`}`, label: ({ dataset, parsed }) => ` ${labelOf(dataset, parsed)}: ${number(Math.abs(Math.round(parsed.y)))}` } },
      },
    },
  };
}
