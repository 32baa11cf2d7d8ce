// SPDX-License-Identifier: Apache-2.0
// The way from page to page: the server lists its pages.

import { make, on } from './dom.js';
import { ROOT, at } from './root.js';
import { plural, tr } from '../language/texts.js';

const COUNT_PERIOD = 10000; // [ms]
/** The titles of pages, by those that the server lists. */
const TITLES = { Simulations: tr`Simulations`, Floor: tr`Floor`, Operations: tr`Operations`, Layout: tr`Layout`, 'What-if': tr`What-if`, API: tr`API`, Docs: tr`Docs` };

async function showPages() {
  const answer = await fetch(at('/pages')).catch(() => null);
  const listed = answer?.ok ? await answer.json() : [];
  const pages = listed.map((page) => ({ ...page, title: TITLES[page.title] ?? page.title }));
  const links = pages.map(({ path, title }) => make('a', { href: at(path), textContent: title }));
  for (const link of links) {
    if (link.pathname === location.pathname) link.setAttribute('aria-current', 'page');
  }
  const hub = ROOT ? [make('a', { href: '/', textContent: TITLES.Simulations })] : [];
  document.querySelector('.site')?.replaceChildren(...hub, ...(links.length > 1 ? links : []));
  // What leads to a page that may not be there, as the documentation that was not built.
  for (const part of document.querySelectorAll('[data-needs]')) part.hidden = !pages.some(({ path }) => path === part.dataset.needs);
  pages.forEach(({ count, title }, i) => count && followCount(links[i], title, count));
}

/** Shows on a page's link how many things wait there for a person. */
async function followCount(link, title, address) {
  const isHere = link.hasAttribute('aria-current');
  if (isHere) on(window, 'count', ({ detail }) => showCount(link, title, detail)); // sooner than others
  const answer = await fetch(at(address)).catch(() => null);
  const { total = 0 } = answer?.ok ? await answer.json() : {};
  showCount(link, title, total);
  if (!isHere) setTimeout(() => followCount(link, title, address), COUNT_PERIOD);
}

function showCount(link, title, total) {
  const label = plural(total, '{n} alarm', '{n} alarms');
  const badge = make('span', { className: 'badge needs-help count', textContent: total, ariaLabel: label, title: label });
  badge.setAttribute('role', 'img');
  link.replaceChildren(title, ...(total ? [badge] : []));
}

/** Links in the pages' files begin at the server's root. */
function moveLinks() {
  for (const link of document.querySelectorAll('a[href^="/"]')) link.setAttribute('href', at(link.getAttribute('href')));
}

if (ROOT) moveLinks();
showPages();
