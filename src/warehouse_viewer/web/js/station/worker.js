// SPDX-License-Identifier: Apache-2.0
// Keeps the files of a station's screen, so that a reload works while the network is gone. What the
// server has is taken first, always; nothing of /api is ever kept.

const NAME = 'station-4';
const PATIENCE = 2500; // for the server, before what is kept is taken [ms]
const MODULES = {
  base: ['api', 'changes', 'dom', 'message_enums', 'question', 'request', 'root', 'world'],
  language: ['texts'],
  station: [
    'awake', 'bench', 'codes', 'main', 'news', 'outbox', 'scanner', 'send', 'settings', 'shelf', 'sounds', 'unit_drawing', 'view', 'wall',
  ],
};
const LANGUAGE = /^\/web\/texts\/[\w-]+\.json$/; // the one that the page asks for
const PAGE = '/web/station.html';
const FILES = [PAGE, '/web/design.css', '/web/station.css', '/web/icon.svg', '/web/js/base/theme.js', '/fonts/inter.woff2',
  ...Object.entries(MODULES).flatMap(([room, names]) => names.map((name) => `/web/js/${room}/${name}.js`))];

self.addEventListener('install', (event) => {
  event.waitUntil(caches.open(NAME).then((cache) => cache.addAll(FILES)).then(() => self.skipWaiting()));
});

self.addEventListener('activate', (event) => {
  event.waitUntil(dropOld().then(() => self.clients.claim()));
});

/** Forgets what other versions of this worker kept. */
async function dropOld() {
  const names = await caches.keys();
  await Promise.all(names.filter((name) => name.startsWith('station-') && name !== NAME).map((name) => caches.delete(name)));
}

self.addEventListener('fetch', (event) => {
  const { request } = event, { pathname, origin } = new URL(request.url);
  if (request.method !== 'GET' || origin !== location.origin) return;
  const key = /^(\/s\/[^/]+)?\/station\/[^/]+$/.test(pathname) ? PAGE : pathname;
  if (FILES.includes(key) || LANGUAGE.test(key)) event.respondWith(freshOrKept(request, key));
});

/** The server's answer, which is kept, too; or what is kept where it does not answer soon. */
async function freshOrKept(request, key) {
  const cache = await caches.open(NAME);
  const asked = fetch(request).then((answer) => {
    if (answer.ok) cache.put(key, answer.clone());
    return answer;
  });
  const late = new Promise((resolve) => setTimeout(resolve, PATIENCE));
  const answer = await Promise.race([asked.catch(() => null), late]);
  return answer ?? await cache.match(key) ?? asked;
}
