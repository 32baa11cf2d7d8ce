// SPDX-License-Identifier: Apache-2.0
// A wall screen: /?kiosk=20 shows the floor and the operations in turn, each for 20 s, without anything to
// press. Escape ends it.

import { make, on } from './base/dom.js';
import { at } from './base/root.js';

const SETTLES = 1000; // [ms]
const LEAST = 5, MOST = 3600, USUAL = 20; // [s]
/** Page by page, and what of it is brought into view. */
const STOPS = [['/', ''], ['/operations', ''], ['/operations', '.gantt-place'], ['/operations', '.orders-place']];

/** Seconds that each view stays, of a page's query. */
export function secondsOf(search) {
  const asked = Number(new URLSearchParams(search).get('kiosk') || USUAL);
  return Number.isFinite(asked) ? Math.min(MOST, Math.max(LEAST, asked)) : USUAL;
}

/** Begins to turn, at this page. */
export function beginKiosk() {
  const seconds = secondsOf(location.search);
  document.documentElement.classList.add('kiosk');
  document.head.append(make('link', { rel: 'stylesheet', href: '/web/kiosk.css' }));
  on(window, 'keydown', ({ key }) => key === 'Escape' && location.replace(location.pathname));
  setTimeout(() => document.getElementById('home')?.click(), SETTLES); // panels have gone
  const here = STOPS.findIndex(([path]) => at(path) === location.pathname);
  setTimeout(() => turn(Math.max(0, here), seconds), 1000 * seconds);
}

/** Goes to what comes after a stop; stays where the server does not answer. */
async function turn(from, seconds) {
  const next = (from + 1) % STOPS.length, [path, part] = STOPS[next];
  if (at(path) === location.pathname) {
    document.querySelector(part)?.scrollIntoView();
    setTimeout(() => turn(next, seconds), 1000 * seconds);
    return;
  }
  const answer = await fetch(at(path), { method: 'HEAD' }).catch(() => null);
  if (answer?.ok) location.replace(`${at(path)}?kiosk=${seconds}`);
  else setTimeout(() => turn(from, seconds), 1000 * seconds);
}

if (new URLSearchParams(globalThis.location?.search).has('kiosk')) beginKiosk();
