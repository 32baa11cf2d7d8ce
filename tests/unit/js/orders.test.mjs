// SPDX-License-Identifier: Apache-2.0
// How many orders wait to be shown.

import assert from 'node:assert/strict';
import { test } from 'node:test';

globalThis.matchMedia = () => ({ matches: false });
const { OrderList } = await import('../../../src/warehouse_viewer/web/js/operations/order_list.js');

/** A list without a page that is being read again while these orders come. */
function reading(news, filter = '') {
  const list = Object.create(OrderList.prototype, { text: { value: '' } });
  return Object.assign(list, { filter, box: {}, newest: 2, news: new Set(news), shift: news.length });
}

const orders = (...numbers) => numbers.map((number) => ({ order_id: number }));

test('an order that came while the list was read waits only if the list lacks it', () => {
  for (const filter of ['', 'state=OPEN']) {
    const list = reading([3, 4], filter);
    list.begun(3, orders(3, 2, 1));
    assert.equal(list.fresh, 1);
    assert.deepEqual([...list.news], [4]);
  }
});
