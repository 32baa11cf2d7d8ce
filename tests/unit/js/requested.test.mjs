// SPDX-License-Identifier: Apache-2.0
// Labels of the storage units that robots which learn are asked for.

import assert from 'node:assert/strict';
import { test } from 'node:test';

const { Requested } = await import('../../../src/warehouse_viewer/web/js/panels/requested.js');

const world = {
  scene: { units: ['storage_unit7', 'storage_unit8'] },
  placeOf: ({ kind, index }) => [index, kind === 'unit' ? 1 : 0, 2, 0],
};

test('labels stand over the units that are requested, and over no other', () => {
  const requested = new Requested(world);
  assert.deepEqual(requested.labels(), []);
  requested.take([8]);
  assert.deepEqual(requested.labels(), [{ text: 'requested', kind: 'pieces', at: [1, 1, 2.4] }]);
  requested.take([7]);
  assert.equal(requested.labels()[0].at[0], 0);
});
