// SPDX-License-Identifier: Apache-2.0
// How often a processor draws the picture.

import assert from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { CROWD, DISPLAY, HURRIED, MOST, Pace, SHARE } from '../../../../src/warehouse_viewer/web/js/scene/pace.js';

let now, told, pace;

beforeEach(() => {
  now = 1000;
  told = [];
  pace = new Pace((gap) => told.push(gap), () => now, (done, ms) => {
    now += ms;
    queueMicrotask(done);
  });
});

/** Draws a picture that takes so long [ms]; returns when the next is drawn, by a display that is half a
 *  picture late. */
async function draw(cost) {
  const begun = now;
  pace.drew(begun, () => now >= begun + cost);
  await pace.rest;
  now += DISPLAY / 2;
  return now - begun;
}

test('a picture takes no more than its share of the time', async () => {
  const gap = await draw(40);
  assert.ok(Math.abs(gap - 40 / SHARE) < 1, `${gap} ms`);
  assert.deepEqual(told, [gap]);
});

test('what is soon drawn is drawn often', async () => {
  assert.ok(await draw(2) < 30);
});

test('at least two pictures a second are drawn, unless one takes longer', async () => {
  assert.equal(await draw(200), 500);
  assert.ok(await draw(900) >= 900);
});

test('pictures come more often while the camera is moved', async () => {
  pace.hurry();
  assert.ok(Math.abs(await draw(40) - 40 / HURRIED) < 1);
});

test('one late picture does not slow the next ones down', async () => {
  for (let i = 0; i < 9; ++i) await draw(8);
  await draw(80);
  for (let i = 0; i < 9; ++i) await draw(8);
  assert.ok(await draw(8) < 60);
});

test('pictures come more often while the simulation keeps its speed, and seldom when it falls behind', async () => {
  pace.yieldTo(0.99, 1); // told once, since it stays so
  for (const end = now + 15000; now < end;) await draw(40);
  assert.ok(Math.abs(await draw(40) - 40 / MOST) < 1);
  pace.yieldTo(0.8, 1);
  for (const end = now + 4000; now < end;) await draw(40);
  assert.ok(Math.abs(await draw(40) - 40 / SHARE) < 1);
  pace.yieldTo(30, 0); // as fast as it can
  await draw(40);
  assert.ok(Math.abs(await draw(40) - 40 / SHARE) < 1);
});

test('a crowd is drawn for a smaller part of the time', async () => {
  pace.expect(CROWD);
  pace.yieldTo(1, 1);
  for (const end = now + 15000; now < end;) await draw(40);
  assert.ok(Math.abs(await draw(40) - 40 / SHARE) < 1);
  pace.expect(CROWD - 1);
  for (const end = now + 15000; now < end;) await draw(40);
  assert.ok(Math.abs(await draw(40) - 40 / MOST) < 1);
});
