// SPDX-License-Identifier: Apache-2.0
// How long a wall screen shows each view, and what the batteries come to.

import assert from 'node:assert/strict';
import { test } from 'node:test';

import { secondsOf } from '../../../src/warehouse_viewer/web/js/kiosk.js';
import { summary } from '../../../src/warehouse_viewer/web/js/operations/batteries.js';

test('a view stays as long as the address says, within reason', () => {
  assert.deepEqual(['?kiosk=30', '?kiosk', '?kiosk=1', '?kiosk=99999', '?kiosk=soon'].map(secondsOf), [30, 20, 5, 3600, 20]);
});

test('batteries are summed up', () => {
  assert.match(summary([0.1, 0.5, 0.9]), /mean 50 %, least 10 %, 1 below 20 %/);
  assert.match(summary([1, 1]), /All are full/);
  assert.match(summary([]), /no robot/);
});
