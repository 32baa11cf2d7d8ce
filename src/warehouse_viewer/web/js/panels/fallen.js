// SPDX-License-Identifier: Apache-2.0
// Items that fell off their storage units: named where they lie, and picked up by a click.

import { post } from '../base/api.js';
import { $, on } from '../base/dom.js';
import { shownName } from '../base/words.js';

const ABOVE = 0.25; // of a name over the item [m]

export class FallenItems {
  /** `selected()` is the name of what is selected, `attempt(request)` what becomes of one. */
  constructor(world, selected, attempt) {
    Object.assign(this, { world, selected, attempt });
    on($('pick-up'), 'click', () => this.pickUp(selected()));
  }

  /** Index of the unit off which the item of that index fell; -1: it did not. */
  unitOf(item) {
    const { fallen_item: items, fallen_from: units } = this.world.scene;
    return units[items.indexOf(item)] ?? -1;
  }

  pickUp(name) {
    return this.attempt(() => post(`/items/${name.match(/\d+$/)[0]}/pick_up`));
  }

  /** [{text, kind, at}], for the Labels. */
  labels() {
    const { fallen_item: items, items: names } = this.world.scene;
    return items.map((item) => {
      const [x, y, z] = this.world.placeOfItem(item);
      return { text: shownName(names[item]), kind: 'blocked', at: [x, y, z + ABOVE] };
    });
  }
}
