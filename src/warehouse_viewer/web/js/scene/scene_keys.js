// SPDX-License-Identifier: Apache-2.0
// The picture by keys: arrows go from robot to robot as they are seen, Enter brings the chosen one
// near, + and - change how large all is. What is chosen is spoken.

import { $, on } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { ACTIVITY } from '../base/words.js';

const WAYS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1] };
const ASIDE = 2.5; // how much farther a way to the side is than one ahead
const ZOOM = 1.25;

export class SceneKeys {
  /** `page` has world, stage, selected, select(name) and find(name). */
  constructor(page) {
    this.page = page;
    on(page.stage.canvas, 'keydown', (event) => this.take(event));
  }

  take(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { key } = event, way = WAYS[key], { page } = this;
    const act = way ? () => this.step(way)
      : { Enter: () => page.selected && page.find(page.selected),
        '+': () => page.stage.zoom(ZOOM), '-': () => page.stage.zoom(1 / ZOOM) }[key];
    if (!act) return;
    event.preventDefault();
    act();
  }

  step(way) {
    const { page } = this, { world, stage } = page;
    const at = Array.from(world.scene.robots, (_, i) => stage.pixelOf(world.shown[3 * i], world.shown[3 * i + 1], 0));
    const thing = world.indexOf.get(page.selected);
    const from = thing ? stage.pixelOf(...world.placeOf(thing).slice(0, 2), 0) : stage.middle();
    const index = nextFrom(from, way, at, thing?.kind === 'robot' ? thing.index : -1);
    if (index < 0) return;
    page.select(world.nameOf({ kind: 'robot', index }));
    page.speak();
  }
}

/** Index of the point [x, y] that is next from one along a way, or -1; `own` is left out. Without an
 *  own one it is the nearest of all. */
export function nextFrom([x, y], [wx, wy], points, own = -1) {
  let best = -1, least = Infinity;
  points.forEach(([px, py], i) => {
    const ahead = (px - x) * wx + (py - y) * wy, aside = Math.abs((px - x) * wy - (py - y) * wx);
    if (i === own || (own >= 0 && (ahead <= 1 || aside > ASIDE * ahead))) return;
    const far = own < 0 ? Math.hypot(px - x, py - y) : ahead + ASIDE * aside;
    if (far < least) [best, least] = [i, far];
  });
  return best;
}

/** Says which robot is chosen, and what it does. */
export function speak(world, index) {
  const name = world.nameOf({ kind: 'robot', index }), load = world.shelf[index];
  const [x, y] = world.placeOf({ kind: 'robot', index });
  $('spoken').textContent = tr`${name}, ${ACTIVITY[world.activity[index]]}${load ? tr`, carries unit ${load}` : ''}, at ${x.toFixed(0)}, ${y.toFixed(0)}`;
}
