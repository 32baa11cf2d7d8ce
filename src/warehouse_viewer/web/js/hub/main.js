// SPDX-License-Identifier: Apache-2.0
// The page of the hub: what runs, and new warehouses.

import { $, make, on, setText } from '../base/dom.js';
import { confirmed } from '../base/question.js';
import { tr } from '../language/texts.js';
import { Card } from './card.js';
import { WishForm } from './form.js';
import { Lists } from './lists.js';
import { SaveForm } from './save.js';
import * as server from './server.js';

const PERIOD = 1000; // between two looks at the list [ms]

class Page {
  constructor() {
    this.cards = new Map();
    this.form = new WishForm(() => this.look());
    this.saving = new SaveForm((text) => this.say(text));
    this.lists = new Lists();
    on($('new'), 'click', () => this.form.open(this.freeName('warehouse')).catch((error) => this.say(error.message)));
    on($('begin'), 'click', () => this.create({ size: 'small', shift: true }));
    on($('drive'), 'click', () => this.create({ size: 'small' }));
    on($('log-close'), 'click', () => $('log').close());
    on($('log'), 'close', () => this.following?.abort());
    on($('insert-cancel'), 'click', () => $('insert').close());
    on($('insert-form'), 'submit', (event) => { event.preventDefault(); this.insert(); });
    this.run();
  }

  async run() {
    for (;;) {
      if (!document.hidden) await this.look();
      await new Promise((resolve) => setTimeout(resolve, PERIOD));
    }
  }

  async look() {
    const rows = await server.list().catch(() => null);
    $('link').dataset.state = rows ? 'live' : 'away';
    setText($('link'), rows ? tr`live` : tr`the hub does not answer`);
    if (!rows) return;
    this.show(rows);
    await this.lists.look();
  }

  show(rows) {
    this.rows = rows;
    const runs = rows.some(({ state }) => ['STARTING', 'RUNNING', 'PAUSED'].includes(state));
    $('welcome').hidden = runs;
    this.playExample(!runs);
    for (const [name, card] of this.cards) {
      if (rows.some((row) => row.name === name)) continue;
      card.element.remove();
      this.cards.delete(name);
    }
    for (const row of rows) {
      if (!this.cards.has(row.name)) this.cards.set(row.name, this.added(row.name));
      this.cards.get(row.name).show(row);
    }
  }

  /** Plays a recorded shift while nothing runs; it is fetched after the first view. */
  async playExample(isWanted) {
    if (isWanted) this.example ??= import('./example.js').then(({ Example }) => new Example()).catch(() => null);
    (await this.example)?.show(isWanted);
  }

  added(name) {
    const card = new Card(name, {
      'Insert a world': (row) => this.openInsert(row),
      'Save as': (row) => this.saving.open(row.name),
      'Keep recording': (row) => this.doing(server.keepRecording(row.name), tr`the last hour of ${row.name} is kept`),
      Log: (row) => this.showLog(row),
      Start: (row) => this.doing(server.start(row.name), tr`${row.name} starts`),
      Restart: (row) => this.restart(row),
      Stop: (row) => this.stop(row),
      Delete: (row) => this.forget(row),
    });
    $('list').append(card.element);
    return card;
  }

  freeName(base) {
    const taken = new Set((this.rows ?? []).map(({ name }) => name));
    for (let i = 1; ; i++) {
      const name = i === 1 ? base : `${base}-${i}`;
      if (!taken.has(name)) return name;
    }
  }

  create(wish) {
    const name = this.freeName(wish.size);
    return this.doing(server.create({ name, ...wish }), tr`${name} starts`);
  }

  async stop(row) {
    const text = tr`Its log, its recordings and its shift stay; it can be started again.`;
    if (await confirmed(tr`Stop ${row.name}?`, text, tr`Stop`)) await this.doing(server.stop(row.name), tr`${row.name} has ended`);
  }

  async restart(row) {
    const text = tr`It ends and begins again with the same arguments; a shift goes on where its database has it.`;
    if (await confirmed(tr`Restart ${row.name}?`, text, tr`Restart`)) await this.doing(server.restart(row.name), tr`${row.name} starts again`);
  }

  async forget(row) {
    const text = tr`Its log, its recordings and the database of its shift are deleted.`;
    if (await confirmed(tr`Delete ${row.name}?`, text, tr`Delete`)) await this.doing(server.stop(row.name, true), tr`${row.name} is deleted`);
  }

  openInsert(row) {
    this.target = row.name;
    setText($('insert-title'), tr`Insert a world into ${row.name}`);
    $('insert-answer').hidden = true;
    server.argumentsOf().then(({ worlds }) => $('worlds').replaceChildren(...worlds.map((value) => make('option', { value }))));
    $('insert').showModal();
  }

  async insert() {
    const { world, file, x, y, yaw, keep } = $('insert-form').elements;
    const content = file.files[0] ? await file.files[0].text() : world.value.trim();
    const place = { x: Number(x.value), y: Number(y.value), yaw: Number(yaw.value) };
    try {
      if (keep.value.trim() && !file.files[0]) throw new Error(tr`keep the file as: choose a file first; a named world is kept already`);
      const { message } = await server.insert(this.target, { world: content, ...place });
      if (keep.value.trim()) await server.keepWorld(keep.value.trim(), content);
      $('insert').close();
      this.say(message);
    } catch (error) {
      $('insert-answer').hidden = false;
      setText($('insert-answer'), error.message);
    }
  }

  showLog(row) {
    this.following = new AbortController();
    setText($('log-title'), tr`Log of ${row.name}`);
    setText($('log-text'), '');
    $('log').showModal();
    server.follow(row.name, showLog, this.following.signal).catch((error) => {
      if (error.name !== 'AbortError') setText($('log-text'), error.message);
    });
  }

  async doing(action, text) {
    try {
      await action;
      this.say(text);
    } catch (error) {
      this.say(error.message, 'refused');
    }
    await this.look();
  }

  say(text, kind = 'done') {
    $('answer').hidden = false;
    $('answer').dataset.kind = kind;
    setText($('answer'), text);
  }
}

function showLog(text) {
  setText($('log-text'), text);
  $('log-text').scrollTop = $('log-text').scrollHeight;
}

window.page = new Page(); // for a look from the console
