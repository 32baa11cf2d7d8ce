// SPDX-License-Identifier: Apache-2.0
// Texts in another language: placeholders, plurals, and English where the language lacks a text.

import assert from 'node:assert/strict';
import { test } from 'node:test';

const POLISH = {
  '{1} of {2} counted': 'z {2} policzono {1}',
  '{n} orders': { one: '{n} zamówienie', few: '{n} zamówienia', many: '{n} zamówień', other: '{n} zamówienia' },
};
const asked = [];
globalThis.location = new URL('http://here/?lang=pl');
globalThis.document = { documentElement: {}, createTreeWalker: () => ({ nextNode: () => null }) };
globalThis.NodeFilter = {};
globalThis.fetch = async (path) => {
  asked.push(path);
  return { ok: true, json: async () => POLISH };
};
const { tr, plural } = await import('../../../src/warehouse_viewer/web/js/language/texts.js');
delete globalThis.document; // other tests have none

test('the address names the language', () => {
  assert.deepEqual(asked, ['/web/texts/pl.json']);
});

test('a language may put what a text holds in another order', () => {
  assert.equal(tr`${2} of ${5} counted`, 'z 5 policzono 2');
});

test('a language has its own plurals', () => {
  assert.deepEqual([1, 2, 5].map((count) => plural(count, '{n} order', '{n} orders')), ['1 zamówienie', '2 zamówienia', '5 zamówień']);
});

test('what a language lacks is English', () => {
  assert.equal(tr`${1} is missing`, '1 is missing');
  assert.deepEqual([1, 2].map((count) => plural(count, '{n} robot', '{n} robots')), ['1 robot', '2 robots']);
});
