// SPDX-License-Identifier: Apache-2.0
// Scenarios in words, what is chosen in their form, and what is drawn of their figures.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { fitsOrders, freeName, ordersText, partsOf } from '../../../src/warehouse_viewer/web/js/whatif/choices.js';
import { demandOf, demandText, describeDesign, edgesOf } from '../../../src/warehouse_viewer/web/js/whatif/design_words.js';
import { eventsOf, linesOf, refusalOf } from '../../../src/warehouse_viewer/web/js/whatif/events.js';
import { changesOf, refusalOf as refusalNow } from '../../../src/warehouse_viewer/web/js/replay/changes.js';
import { differenceOf, endOf, rangeOf } from '../../../src/warehouse_viewer/web/js/whatif/from_now.js';
import { expectedOf } from '../../../src/warehouse_viewer/web/js/whatif/numbers.js';
import { named } from '../../../src/warehouse_viewer/web/js/whatif/intro.js';
import { hashOf, namesOf } from '../../../src/warehouse_viewer/web/js/whatif/picks.js';
import { chartOf, topOf } from '../../../src/warehouse_viewer/web/js/whatif/whiskers.js';
import { describe, differences, duration, interval, limitOf, ordersOf } from '../../../src/warehouse_viewer/web/js/whatif/words.js';

const MEDIUM = { layout: 'medium', robots: 0, stations: 0, orders: 'fill', minutes: 60, seeds: 5, physics: false, realism: '', policies: {} };
const SITE = { name: 'medium', robots: 20, stations: 4 };
const USUAL = { orders: 'pile-on', idle: 'wait' };

test('a scenario is told in a line', () => {
  assert.equal(describe(MEDIUM, SITE), 'medium · 20 robots · 4 stations · orders never run out · 60 min × 5 · ideal robots');
  const own = { ...MEDIUM, layout: 'north.layout.yaml', orders: 'mix:300:2x1.5', physics: true, realism: 'bad_day', policies: { idle: 'park' } };
  assert.equal(describe(own, { ...SITE, robots: 1 }),
    'north · 1 robot · 4 stations · 300 orders an hour of 2 lines × 1.5 pieces · 60 min × 5 · simulated, bad day · idle: park');
});

test('only what is not the same differs', () => {
  const first = { settings: MEDIUM, site: SITE };
  const other = { settings: { ...MEDIUM, robots: 30, policies: { orders: 'random', idle: 'wait' } }, site: { ...SITE, robots: 30 } };
  assert.deepEqual(differences([first, other], USUAL), [['Robots', ['20', '30']], ['Which order a station takes on', ['pile-on', 'random']]]);
  assert.deepEqual(differences([first, first], USUAL), []);
});

test('events are lines of a field', () => {
  const lines = ['2:00:00 close pick1', '90m robots +2', '3h fail 20% for 30m', '600 fail robot 7', '1h picker pick2 14 2', '5m sku_out bolt m8', '6m priority rush 17 9', '7m policy units most lines'];
  const events = eventsOf(`${lines.join('\n')}\n\n  `);
  assert.deepEqual(events[2], { at: '3h', fail: '20%', for: '30m' });
  assert.deepEqual(events[4], { at: '1h', picker: { station: 'pick2', seconds_a_piece: 14, pickers: 2 } });
  assert.deepEqual(events[6], { at: '6m', priority: { order: 'rush 17', to: 9 } });
  assert.deepEqual(events[7], { at: '7m', policy: { units: 'most lines' } });
  assert.deepEqual(linesOf(events), lines);
  assert.deepEqual(linesOf(undefined), []);
  assert.deepEqual(eventsOf('close'), [{ at: 'close', '': '' }]); // the server says what is wrong
});

test('a refusal names the event as a person counts', () => {
  assert.equal(refusalOf("events[1].close: is 3; the name of a station was expected"), 'Event 2: close is 3; the name of a station was expected');
  assert.equal(refusalOf("events[0].at: is 'x'; seconds"), "Event 1: its time is 'x'; seconds");
  assert.equal(refusalOf('small: 900 robots'), 'small: 900 robots');
});

test('numbers are expected in words', () => {
  assert.equal(expectedOf({ min: '1', max: '20000', step: '' }), 'a whole number from 1 to 20,000 is expected');
  assert.equal(expectedOf({ min: '0.01', max: '100', step: 'any' }), 'a number from 0.01 to 100 is expected');
  assert.equal(expectedOf({ min: '1', max: '', step: 'any' }), 'a number from 1 on is expected');
});

test('files are offered for the orders that they hold', () => {
  assert.deepEqual(['file', 'day', 'demand'].map((kind) => fitsOrders(kind, 'a.csv')), [true, true, false]);
  assert.equal(fitsOrders('demand', 'a.demand.yaml'), true);
});

test('orders of the form are those of simulate', () => {
  for (const orders of ['fill', 'mix:300:1.55x1.05', 'monday.csv', 'poisson:20', 'fill:9', 'day:monday.csv', 'demand:a.demand.yaml*1.3']) {
    assert.equal(ordersText(partsOf(orders)), orders);
  }
  assert.equal(ordersOf('mix:1200:1.55x1.05'), '1,200 orders an hour');
  assert.equal(ordersOf('monday.csv'), 'orders of monday.csv');
  assert.equal(ordersOf('day:monday.csv'), 'the day of monday.csv');
  assert.equal(ordersOf('demand:day.demand.yaml*1.3'), 'days as day, × 1.3');
});

test('names are free, and the picks are in the address', () => {
  assert.equal(freeName('small', ['medium']), 'small');
  assert.equal(freeName('small', ['small', 'small 2']), 'small 3');
  assert.deepEqual(named([['small', 1], ['small', 2]], ['small']), [['small 2', 1], ['small 3', 2]]);
  assert.deepEqual(namesOf(hashOf(['a b', 'c,d', '50 %'])), ['a b', 'c,d', '50 %']);
  assert.deepEqual(namesOf('#compare=50%'), ['50%']);
  assert.deepEqual(namesOf('#else'), []);
});

test('figures have their intervals, and seconds are told as people say them', () => {
  assert.equal(interval({ mean: 1405.4, half: 11.6 }), '1,405 ± 12');
  assert.equal(interval({ mean: -0.04, half: null }, 1), '−0.0');
  assert.deepEqual([3, 47, 61, 3600, 8000].map(duration), ['5 s', '50 s', '2 min', '1 h 0 min', '2 h 14 min']);
});

test('what limits a scenario is told with its hours', () => {
  assert.equal(limitOf({ what: 'the robots', when: '' }), 'the robots');
  assert.equal(limitOf({ what: 'the picking stations', when: '3:20 to 5:20' }), 'the picking stations, 3:20 to 5:20');
});

test('a chart begins at zero and shows all of each interval', () => {
  const cells = [{ mean: 10, half: 2 }, { mean: 30, half: 5 }, { mean: 1, half: 4 }, { mean: 8, half: null }];
  const shown = chartOf(['a', 'b', 'c', 'd'], { title: 'Pieces picked', unit: 'an hour', digits: 0, cells });
  assert.deepEqual(shown.ranges, [[8, 12], [25, 35], [0, 5], null]);
  assert.equal(shown.axis, 'Pieces picked an hour');
  assert.ok(topOf(shown) > 35);
  assert.equal(chartOf(['a'], { title: 'Late orders', unit: '%', digits: 1, cells: [cells[0]] }).axis, 'Late orders [%]');
});

test('the demand and the edges of a building are those of the program', () => {
  for (const demand of ['day.csv', 'day.demand.yaml*1.3', '']) assert.equal(demandText(demandOf(demand)), demand);
  assert.deepEqual(['36 x 26', '36×26', '36, 26', ' 36x26 ', 'large'].map(edgesOf), ['36x26', '36x26', '36x26', '36x26', 'large']);
  assert.equal(describeDesign({ building: 'hall.layout.yaml', demand: 'day.csv*1.3', late: 0.005, cpu_hours: 2, seed: 1 }), 'hall · day.csv × 1.3 · 0.5 % may be late · 2 CPU h · seed 1');
});

test('what comes of the shift that runs is a column', () => {
  assert.deepEqual(changesOf('close pick1\n\n +10m robots +2 \n2:30:00 open pick1'), ['+0 close pick1', '+10m robots +2', '2:30:00 open pick1']);
  assert.equal(rangeOf({ p10: [1, 370.2], p50: [2, 414.4], p90: [3, 437] }), '414 (370–437)');
  assert.equal(endOf({ p10: 3000, p50: 3240, p90: null }), '0:54:00 (0:50:00–later)');
  assert.equal(endOf({ p10: null, p50: null, p90: null }), 'not within');
  assert.equal(differenceOf('all done; against as it is: -61.4 ± 10.6 orders done'), '-61.4 ± 10.6 orders done');
  assert.equal(differenceOf('done; against as it is: -1,061.4 ± 10.6 orders done, +0.0 late in each of 7 runs'), '-1,061.4 ± 10.6 orders done\n+0.0 late in each of 7 runs');
  assert.equal(differenceOf('all done'), '');
  assert.equal(refusalNow("'+0 robots 0': robots is '0'", 'robots 0'), "'robots 0': robots is '0'");
  assert.equal(refusalNow("'+0 robots 0': robots is '0'", '+0 robots 0'), "'+0 robots 0': robots is '0'");
});
