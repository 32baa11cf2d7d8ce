// SPDX-License-Identifier: Apache-2.0
// Why a robot or station waited in a span of the last hour, in the server's sentence.

import { get } from '../base/api.js';
import { Activity } from '../base/words.js';

const MOST = 300; // sentences that are kept

export class GanttWhy {
  constructor() {
    this.known = new Map();
  }

  /** The sentence for a row's span; '': it did not wait, or it is forgotten. */
  async of({ name }, span) {
    if (!span || span.state < Activity.WAITING) return '';
    const key = `${name} ${span.from}`;
    if (!this.known.has(key)) {
      const time = ((span.from + span.to) / 2).toFixed(1);
      const asked = get(`/why/${encodeURIComponent(name)}?time=${time}`).then(({ sentence }) => sentence.replace(`${name} `, ''), () => '');
      this.known.set(key, asked);
      if (this.known.size > MOST) this.known.delete(this.known.keys().next().value);
    }
    return this.known.get(key);
  }
}
