// SPDX-License-Identifier: Apache-2.0
// Closed zones: what their labels say, and the rectangles that are drawn.

import assert from 'node:assert/strict';
import { test } from 'node:test';

const { edgesOf, noteOf } = await import('../../../src/warehouse_viewer/web/js/layers/zones.js');
const { rectangleOf } = await import('../../../src/warehouse_viewer/web/js/panels/zone_tool.js');

test('a label says how long a zone stays closed, and who is inside', () => {
  assert.equal(noteOf({ until: 100, inside: [] }, 40), '60 s left');
  assert.equal(noteOf({ until: null, inside: ['kiva3', 'kiva7'] }, 40), 'until opened · 2 inside');
});

test('a rectangle holds the cells of both corners, from whichever it is drawn', () => {
  const cells = { x_min: 0.5, x_max: 4.5, y_min: -2.5, y_max: 3.5 };
  assert.deepEqual(rectangleOf([1, -2], [4, 3], 1), cells);
  assert.deepEqual(rectangleOf([4, -2], [1, 3], 1), cells);
});

test('its edges close', () => {
  const edges = edgesOf({ x_min: 0, x_max: 2, y_min: 0, y_max: 1 });
  assert.equal(edges.length, 24);
  for (let i = 0; i < 4; ++i) {
    assert.deepEqual(edges.slice(6 * i + 3, 6 * i + 6), edges.slice((6 * i + 6) % 24, ((6 * i + 6) % 24) + 3));
  }
});
