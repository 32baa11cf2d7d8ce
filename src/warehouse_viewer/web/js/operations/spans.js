// SPDX-License-Identifier: Apache-2.0
// The states of robots and stations over the last hour, as span_log.py encodes them.

const GONE = 7; // nothing is known
const STATES = 5; // that a row can be in

/** The {head, times, counts, changes} of an answer. */
export function decode(buffer) {
  const [length] = new Uint32Array(buffer, 0, 1);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const at = 4 + length, { moments } = head;
  return { head, times: new Float32Array(buffer, at, moments), counts: new Uint32Array(buffer, at + 4 * moments, moments),
    changes: new Uint32Array(buffer, at + 8 * moments) };
}

/** The spans of one robot or station: when it came into which state, the oldest first. */
class Row {
  constructor(kind, name) {
    Object.assign(this, { kind, name, times: [], states: [] });
  }

  push(time, state) {
    this.times.push(time);
    this.states.push(state);
  }

  /** Forgets what ended before `begin` [s]. */
  trim(begin) {
    const first = this.indexAt(begin);
    if (first <= 0) return;
    this.times.splice(0, first);
    this.states.splice(0, first);
  }

  /** The span in which `time` [s] lies; -1: before the first one. */
  indexAt(time) {
    let low = 0, high = this.times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle] <= time) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  /** {state, from, to} of the i-th span, within what is known. */
  span(i, { begin, now }) {
    return { state: this.states[i], from: Math.max(begin, this.times[i]), to: Math.min(now, this.times[i + 1] ?? now) };
  }

  /** The share of the known time in each state, of those that count. */
  shares(time) {
    const spent = Array.from({ length: STATES }, () => 0);
    for (let i = 0; i < this.times.length; ++i) {
      const { state, from, to } = this.span(i, time);
      if (state < STATES && to > from) spent[state] += to - from;
    }
    const sum = spent.reduce((a, b) => a + b, 0);
    return spent.map((seconds) => (sum ? seconds / sum : 0));
  }
}

export class Spans {
  constructor() {
    this.clear();
  }

  clear() {
    Object.assign(this, { epoch: 0, last: 0, begin: 0, now: 0, rows: [] });
  }

  /** What the server should be asked for. */
  get query() {
    return `epoch=${this.epoch}&since=${this.last}&known=${this.rows.length}`;
  }

  /** Takes an answer in. */
  take(buffer) {
    const { head, times, counts, changes } = decode(buffer);
    if (head.is_whole) this.clear();
    Object.assign(this, { epoch: head.epoch, last: head.last, begin: head.begin, now: head.now });
    for (const [kind, name] of head.rows) this.rows.push(new Row(kind, name));
    if (head.is_whole) head.base.forEach((state, i) => state !== GONE && this.rows[i].push(head.begin, state));
    let at = 0;
    times.forEach((time, moment) => {
      for (const end = at + counts[moment]; at < end; ++at) this.rows[changes[at] >>> 3].push(head.origin + time, changes[at] & 7);
    });
    for (const row of this.rows) row.trim(head.begin);
  }
}
