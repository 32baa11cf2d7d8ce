// SPDX-License-Identifier: Apache-2.0
// Alarms are told to a screen reader, and not more often than a person listens.

import assert from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { AlarmVoice } from '../../../src/warehouse_viewer/web/js/base/alarm_voice.js';

let told, waiting, voice;

beforeEach(() => {
  [told, waiting] = [[], []];
  voice = new AlarmVoice((text) => told.push(text), (act) => waiting.push(act));
});

const alarm = (id) => ({ id, title: `T${id}`, text: `x${id}`, to_do: `Do ${id}.` });

test('an alarm is told once, with what to do', () => {
  voice.take([alarm(1)]);
  voice.take([alarm(1)]);
  assert.deepEqual(told, ['Alarm: T1. x1. Do 1.']);
});

test('those that come while one is read are told together, the worst by name', () => {
  voice.take([alarm(1)]);
  voice.take([alarm(3), alarm(1)]);
  voice.take([alarm(4), alarm(3), alarm(2), alarm(1)]);
  assert.equal(told.length, 1);
  waiting.shift()();
  assert.deepEqual(told[1], 'Alarm: T4. x4. Do 4. 2 more alarms.');
  waiting.shift()();
  assert.equal(told.length, 2);
});

test('what is over before it could be told is not told', () => {
  voice.take([alarm(1)]);
  voice.take([alarm(2), alarm(1)]);
  voice.take([alarm(1)]);
  waiting.shift()();
  assert.equal(told.length, 1);
});

test('after quiet, the next is told at once', () => {
  voice.take([alarm(1)]);
  waiting.shift()();
  voice.take([alarm(2)]);
  assert.deepEqual(told.at(-1), 'Alarm: T2. x2. Do 2.');
});

test('one that comes back is told again', () => {
  voice.take([alarm(1)]);
  waiting.shift()();
  voice.take([]);
  voice.take([alarm(1)]);
  assert.equal(told.length, 2);
});
