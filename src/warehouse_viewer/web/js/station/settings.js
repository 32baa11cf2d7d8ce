// SPDX-License-Identifier: Apache-2.0
// What is set for this device: the scanner's prefix; a code typed by hand; and how far a reload works.

import { $, on } from '../base/dom.js';
import { ask } from '../base/question.js';
import { ROOT, at } from '../base/root.js';
import { tr } from '../language/texts.js';
import { Shelf } from './shelf.js';

const WORKER = at('/station-worker.js');

export class Settings {
  /** scan(code) takes a code that was typed. */
  constructor(name, scanner, scan) {
    Object.assign(this, { scanner, scan, shelf: new Shelf('station/') });
    scanner.prefix = this.shelf.read('prefix') ?? '';
    $('labels').href = `${ROOT}/station/${encodeURIComponent(name)}/labels`;
    on($('settings-open'), 'click', () => this.open());
    on($('prefix'), 'keydown', (event) => this.takeKey(event));
    this.keepPage();
  }

  async open() {
    $('prefix').value = this.scanner.prefix;
    $('code').value = '';
    const answer = await ask($('settings'));
    this.setPrefix($('prefix').value);
    const code = $('code').value.trim();
    if (answer === 'code' && code) this.scan(code);
  }

  /** A key with a name, such as F8, is set by pressing it. */
  takeKey(event) {
    if (!/^F\d+$/.test(event.key)) return;
    event.preventDefault();
    $('prefix').value = event.key;
  }

  setPrefix(text) {
    const prefix = /^(F\d+|.)$/.test(text) ? text : '';
    this.scanner.prefix = prefix;
    this.shelf.write('prefix', prefix);
  }

  /** Has the browser keep the page's files, so that it can be reloaded without a network. */
  async keepPage() {
    const without = tr`Picks are kept here all the same, but a reload needs the network`;
    try {
      if (!navigator.serviceWorker) throw new Error(tr`this address is not secure (https)`);
      await navigator.serviceWorker.register(WORKER, { scope: at('/station/') });
      $('reload-hint').textContent = tr`This page can be reloaded without the network.`;
    } catch (error) {
      $('reload-hint').textContent = `${without}: ${error.message}.`;
    }
  }
}
