// SPDX-License-Identifier: Apache-2.0
// A recording as the server has it: what there is, and its chunks and scenes, the last ones of which
// are kept.

import { reasonOf } from '../base/request.js';
import { at } from '../base/root.js';
import { tr } from '../language/texts.js';
import { read } from './chunk.js';

const KEPT = 12; // chunks

export class Recording {
  constructor(ask = (path) => fetch(at(path))) {
    this.ask = ask;
    this.chunks = []; // {number, scene, begin, end, wall}
    this.marks = []; // {time, kind, model, text}
    this.loaded = new Map(); // promises by chunk's number
    this.scenes = new Map(); // promises by number
    Object.assign(this, { id: '', live: false, begin: 0, end: 0, open: 0, about: {}, cut: '', forecasts: false });
  }

  /** Fetches the index; false if the server keeps no recording. */
  async refresh() {
    const answer = await this.ask('/recording/index');
    if (answer.status === 404 || answer.status === 409) return false;
    const index = await body(answer, 'json');
    if (index.id !== this.id) this.forget();
    else this.forgetOpen();
    this.take(index);
    return true;
  }

  take(index) {
    Object.assign(this, index, {
      chunks: index.chunks.map(([number, scene, begin, end, wall]) => ({ number, scene, begin, end, wall })),
      marks: index.marks.map(([time, kind, model, text]) => ({ time, kind, model, text })),
    });
  }

  forget() {
    this.loaded.clear();
    this.scenes.clear();
  }

  /** The chunk that went on, as it was. */
  forgetOpen() {
    this.loaded.delete(this.open);
  }

  /** The chunk at a time [s], or the nearest; undefined: there is none. */
  chunkAt(time) {
    return this.chunks.findLast(({ begin }) => begin <= time) ?? this.chunks[0];
  }

  after({ number }) {
    return this.chunks[this.chunks.findIndex((chunk) => chunk.number === number) + 1];
  }

  /** A chunk's {updates, texts}. */
  load({ number, end }) {
    if (!this.loaded.has(number)) {
      const coming = this.get(`chunks/${number}`, 'arrayBuffer').then((buffer) => until(read(buffer), end));
      coming.catch(() => this.loaded.delete(number)); // it is requested again
      this.loaded.set(number, coming);
      while (this.loaded.size > KEPT) this.loaded.delete(this.loaded.keys().next().value);
    }
    return this.loaded.get(number);
  }

  scene(number) {
    if (!this.scenes.has(number)) {
      const coming = this.get(`scenes/${number}`, 'json').then((scene) => ({ ...scene, revision: number }));
      coming.catch(() => this.scenes.delete(number));
      this.scenes.set(number, coming);
    }
    return this.scenes.get(number);
  }

  async get(path, kind) {
    return body(await this.ask(`/recording/${path}?of=${this.id}`), kind);
  }
}

/** Drops what came after the end: the world went back. */
function until({ updates, texts }, end) {
  const inTime = ({ stamp }) => stamp <= end + 0.75; // a chunk that still grows is longer than the index says
  return { updates: updates.filter(inTime), texts: texts.filter(inTime) };
}

async function body(answer, kind) {
  if (answer.ok) return answer[kind]();
  const reply = await answer.json().catch(() => ({}));
  throw new Error(reasonOf(reply.detail) ?? tr`the server failed: ${answer.status}`);
}
