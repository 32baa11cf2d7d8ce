// SPDX-License-Identifier: Apache-2.0
// The way from page to page: the server tells which pages it has.

import { make } from './dom.js';

async function showPages() {
  const answer = await fetch('/pages').catch(() => null);
  const pages = answer?.ok ? await answer.json() : [];
  const links = pages.map(({ path, title }) => make('a', { href: path, textContent: title }));
  for (const link of links) {
    if (link.pathname === location.pathname) link.setAttribute('aria-current', 'page');
  }
  document.querySelector('.site')?.replaceChildren(...(links.length > 1 ? links : []));
}

showPages();
