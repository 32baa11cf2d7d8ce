// SPDX-License-Identifier: Apache-2.0
// All of a floor is in the picture, and as large as it goes.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { axesOf, cornersOf, positionFor, seeAll } from '../../../../src/warehouse_viewer/web/js/scene/fit.js';

const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);

/** [x, y] in the picture, its edges at -1 and 1. */
function seen(point, position, axes, half) {
  const from = point.map((x, i) => x - position[i]);
  const depth = dot(from, axes.ahead);
  return [dot(from, axes.right) / depth / half[0], dot(from, axes.up) / depth / half[1]];
}

for (const [name, bounds, half] of [
  ['a wide floor in a wide picture', [-40, 40, -10, 10], [0.6, 0.4]],
  ['a wide floor in a phone', [-40, 40, -10, 10], [0.2, 0.35]],
  ['a long floor, off the origin', [10, 30, -100, 100], [0.5, 0.4]],
]) {
  for (const heading of [0, Math.PI / 2]) {
    test(`${name}, looking along ${heading ? 'y' : 'x'}`, () => {
      const axes = axesOf(0.75, heading);
      const corners = cornersOf(bounds, 1);
      const at = corners.map((p) => seen(p, positionFor(corners, axes, half), axes, half));
      const reach = [0, 1].map((i) => Math.max(...at.map((p) => Math.abs(p[i]))));
      assert.ok(Math.max(...reach) < 1 + 1e-9, `out of the picture: ${reach}`);
      assert.ok(Math.max(...reach) > 1 - 1e-9, `smaller than it could be: ${reach}`);
      for (const i of [0, 1]) {
        const along = at.map((p) => p[i]);
        assert.ok(Math.abs(Math.max(...along) + Math.min(...along)) < 1e-9, `out of the middle: ${along}`);
      }
    });
  }
}

test('the axes are a right-handed frame that looks down', () => {
  const { right, up, ahead } = axesOf(0.6, 1.1);
  for (const [a, b] of [[right, up], [up, ahead], [right, ahead]]) assert.ok(Math.abs(dot(a, b)) < 1e-12);
  const across = [0, 1, 2].map((i) => right[(i + 1) % 3] * up[(i + 2) % 3] - right[(i + 2) % 3] * up[(i + 1) % 3]);
  across.forEach((x, i) => assert.ok(Math.abs(x + ahead[i]) < 1e-12));
  assert.ok(ahead[2] < 0);
});

test('a floor that is long across the view is looked at along x', () => {
  const wide = [0.8, 0.4];
  assert.ok(seeAll([-10, 10, -80, 80], 1, 0.75, wide).position[0] < 0);
  assert.ok(seeAll([-80, 80, -10, 10], 1, 0.75, wide).position[1] < 0);
  const { position, target } = seeAll([-80, 80, -10, 10], 1, 0.75, wide);
  assert.ok(Math.abs(target[2]) < 1e-9 && position[2] > 0);
});
