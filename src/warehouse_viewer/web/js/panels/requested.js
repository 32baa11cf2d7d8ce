// SPDX-License-Identifier: Apache-2.0
// Labels at the storage units that learning robots are asked for.

import { tr } from '../language/texts.js';

const ABOVE = 0.4; // of a label over the unit's place [m]

export class Requested {
  constructor(world) {
    this.world = world;
    this.names = new Set();
  }

  /** Takes the numbers of the units. */
  take(units) {
    this.names = new Set(units.map((number) => `storage_unit${number}`));
  }

  /** [{text, kind, at}], for the Labels. */
  labels() {
    if (!this.names.size) return [];
    return this.world.scene.units.flatMap((name, index) => {
      if (!this.names.has(name)) return [];
      const [x, y, z] = this.world.placeOf({ kind: 'unit', index });
      return [{ text: tr`requested`, kind: 'pieces', at: [x, y, z + ABOVE] }];
    });
  }
}
