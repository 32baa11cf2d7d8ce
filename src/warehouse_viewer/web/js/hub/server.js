// SPDX-License-Identifier: Apache-2.0
// What the page asks the hub.

import { ask, send } from '../base/request.js';

const SIMULATIONS = '/api/v1/simulations';
const pathOf = (name, rest = '') => `${SIMULATIONS}/${encodeURIComponent(name)}${rest}`;

export const list = async () => (await ask('GET', SIMULATIONS)).simulations;
export const argumentsOf = () => ask('GET', '/api/v1/simulation-arguments');
export const create = (wish) => ask('POST', SIMULATIONS, wish);
export const start = (name) => ask('POST', pathOf(name, '/start'));
export const restart = (name) => ask('POST', pathOf(name, '/restart'));
export const save = (name, asked) => ask('POST', pathOf(name, '/save'), asked);
export const keepRecording = (name) => ask('POST', pathOf(name, '/recording'));
export const keepWorld = (world, text) => ask('PUT', `/api/v1/worlds/${encodeURIComponent(world)}`, { text });
export const recordings = async () => (await ask('GET', '/api/v1/recordings')).recordings;
export const journal = async (since) => (await ask('GET', `/api/v1/journal?since=${since}`)).entries;
export const stop = (name, forget = false) => ask('DELETE', pathOf(name, forget ? '?forget=true' : ''));
export const insert = (name, world) => ask('POST', pathOf(name, '/worlds'), world);

/** Calls `show` with the whole log as it grows, until the signal aborts or the simulation ends. */
export async function follow(name, show, signal) {
  const answer = await send('GET', pathOf(name, '/log?follow=true'), undefined, signal);
  const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
  let text = '';
  for (let { done, value } = await reader.read(); !done; { done, value } = await reader.read()) {
    text = (text + value).slice(-200000);
    show(text);
  }
}
