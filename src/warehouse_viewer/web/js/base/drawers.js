// SPDX-License-Identifier: Apache-2.0
// Panels that open and close over the picture, one at a time in each place; what is open stays so
// when the page is opened again. And what panels cover.

import { $, on } from './dom.js';

const NARROW = matchMedia('(max-width: 760px)'); // as in floor.css: one place for all
const GAP = 8; // [px]
const ROOMY = 1200; // a window in which the list leaves the floor enough [px]
const OPEN_AT_FIRST = { wide: innerWidth < ROOMY ? ['view-panel'] : ['list-panel', 'view-panel'], narrow: [] };
const PASSING = 'details-panel'; // it comes and goes with what is selected

const all = () => [...document.querySelectorAll('.drawer')];
const width = () => (NARROW.matches ? 'narrow' : 'wide');

export class Drawers {
  /** `changed()` is called when the picture has more room or less. */
  constructor(changed) {
    this.changed = changed;
    for (const button of document.querySelectorAll('[data-drawer]')) {
      on(button, 'click', () => this.toggle(button.dataset.drawer));
    }
    on(NARROW, 'change', () => this.recall());
    const sizes = new ResizeObserver(() => this.fit());
    for (const element of [$('bar'), $('rail'), ...all()]) sizes.observe(element);
    this.recall();
  }

  isOpen(id) {
    return $(id).classList.contains('open');
  }

  /** Whether the window has room for one drawer alone. */
  get isNarrow() {
    return NARROW.matches;
  }

  toggle(id) {
    if (this.isOpen(id)) this.close(id);
    else this.open(id);
  }

  /** Opens a drawer, and closes what is open in its place. */
  open(id) {
    const place = placeOf($(id));
    for (const drawer of all()) if (placeOf(drawer) === place) drawer.classList.toggle('open', drawer.id === id);
    this.keep();
  }

  close(id) {
    $(id).classList.remove('open');
    this.keep();
  }

  /** Opens what was open in a window of this width last. */
  recall() {
    const open = recalled();
    for (const drawer of all()) {
      drawer.classList.toggle('open', open.includes(drawer.id) || (drawer.id === PASSING && !NARROW.matches));
    }
    this.fit();
  }

  keep() {
    const open = all().filter(({ id }) => this.isOpen(id) && id !== PASSING).map(({ id }) => id);
    localStorage.setItem(`drawers-${width()}`, JSON.stringify(open));
    this.fit();
  }

  /** Shows on the buttons what is open, and gives the style sheet the rest of the window. */
  fit() {
    for (const button of document.querySelectorAll('[data-drawer]')) {
      button.setAttribute('aria-expanded', String(this.isOpen(button.dataset.drawer)));
    }
    const margins = marginsOf(), { style } = document.documentElement;
    const before = style.cssText;
    for (const [side, px] of Object.entries(margins)) style.setProperty(`--free-${side}`, `${Math.ceil(px)}px`);
    if (style.cssText !== before) this.changed();
  }
}

function recalled() {
  try {
    return JSON.parse(localStorage.getItem(`drawers-${width()}`)) ?? OPEN_AT_FIRST[width()];
  } catch { // another program wrote it
    return OPEN_AT_FIRST[width()];
  }
}

const placeOf = (drawer) => (NARROW.matches ? 'all' : drawer.dataset.place);

/** What the bar, the rail and open drawers cover at the edges of the window [px]: {left, right, top,
 *  bottom}. A drawer covers the edge that it lies at. */
export function marginsOf() {
  const shown = all().filter((drawer) => drawer.checkVisibility())
    .map((drawer) => ({ place: placeOf(drawer), box: drawer.getBoundingClientRect() }));
  const within = (place) => shown.filter((drawer) => drawer.place === place).map(({ box }) => box);
  const rail = $('rail').getBoundingClientRect(), foot = footOf();
  const top = $('bar').getBoundingClientRect().bottom + GAP;
  if (NARROW.matches) {
    const low = Math.min(rail.top, ...within('all').map((box) => box.top));
    return { left: GAP, right: GAP, top, bottom: innerHeight - low + GAP };
  }
  return {
    left: Math.max(rail.right, ...within('left').map((box) => box.right)) + GAP,
    // The selection lies over the picture, which would else jump at each click.
    right: innerWidth - Math.min(innerWidth, ...within('edge').map((box) => box.left)) + GAP,
    top,
    bottom: Math.max(foot, ...within('bottom').map((box) => innerHeight - box.top)) + GAP,
  };
}

/** Height of what lies along the window's lower edge [px]. */
function footOf() {
  return parseFloat(getComputedStyle(document.documentElement).getPropertyValue('--foot')) || 0;
}
