// SPDX-License-Identifier: Apache-2.0
// What the page asks the hub.

import { ask, send } from '../base/request.js';

const SIMULATIONS = '/api/v1/simulations';
const pathOf = (name, rest = '') => `${SIMULATIONS}/${encodeURIComponent(name)}${rest}`;

export const list = async () => (await ask('GET', SIMULATIONS)).simulations;
export const argumentsOf = () => ask('GET', '/api/v1/simulation-arguments');
export const create = (wish) => ask('POST', SIMULATIONS, wish);
export const start = (name) => ask('POST', pathOf(name, '/start'));
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
