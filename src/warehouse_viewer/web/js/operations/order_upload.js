// SPDX-License-Identifier: Apache-2.0
// Orders from a CSV file, chosen or dropped: checked first, then all accepted, or none.

import { post } from '../base/api.js';
import { $, make, on } from '../base/dom.js';
import { number } from '../language/numbers.js';
import { plural, tr } from '../language/texts.js';

const MOST = 4_000_000; // characters
const MOST_FAULTS = 20; // faults that the server lists
const SAVE_AS = tr`save it as CSV in UTF-8 (in spreadsheets: 'CSV UTF-8')`;

const isFile = (event) => event.dataTransfer?.types.includes('Files');

const ordersOf = (count) => plural(count, '{n} order', '{n} orders');

/** What a table has: '2 orders, 3 lines, 4 pieces'. */
export function sizeOf({ orders, lines, pieces }) {
  return [ordersOf(orders), plural(lines, '{n} line', '{n} lines'), plural(pieces, '{n} piece', '{n} pieces')].join(', ');
}

export class OrderUpload {
  /** `done(text)` is called once orders are accepted. */
  constructor(done) {
    this.done = done;
    on($('upload'), 'click', () => $('file').click());
    on($('file'), 'change', () => {
      const [file] = $('file').files;
      $('file').value = ''; // the same file may be chosen again
      if (file) this.check(file);
    });
    on($('sheet-no'), 'click', () => $('sheet').close());
    on($('sheet-yes'), 'click', () => this.submit());
    this.takeDrops($('orders-place'));
  }

  takeDrops(place) {
    let depth = 0; // of elements within that the pointer has entered
    const drag = (by) => {
      depth = Math.max(0, depth + by);
      place.classList.toggle('takes-drop', depth > 0);
    };
    on(window, 'dragover', (event) => isFile(event) && event.preventDefault()); // or the browser opens it
    on(window, 'drop', (event) => isFile(event) && event.preventDefault());
    on(place, 'dragenter', (event) => isFile(event) && drag(1));
    on(place, 'dragleave', (event) => isFile(event) && drag(-1));
    on(place, 'drop', (event) => {
      drag(-depth);
      const [file] = event.dataTransfer.files;
      if (file) this.check(file);
    });
  }

  async check(file) {
    this.name = file.name;
    try {
      this.table = await textOf(file);
      this.show(await this.send(true));
    } catch (error) {
      this.say(tr`${file.name} is not accepted`, error.message);
    }
  }

  send(checkOnly) {
    return post('/orders/table', { table: this.table, check_only: checkOnly });
  }

  show(answer) {
    if (!answer.accepted) {
      const some = answer.faults.length < MOST_FAULTS ? tr`What is wrong` : tr`The first ${MOST_FAULTS} faults`;
      this.say(tr`${this.name} is not accepted`, tr`None of its orders is in the list. ${some}:`, answer.faults);
      return;
    }
    this.say(this.name, tr`${sizeOf(answer)}. Nothing is wrong with them.`);
    Object.assign($('sheet-yes'), { hidden: false, disabled: false, textContent: tr`Submit ${ordersOf(answer.orders)}` });
    $('sheet-yes').focus();
  }

  async submit() {
    $('sheet-yes').disabled = true; // what is pressed twice would be ordered twice
    try {
      const answer = await this.send(false);
      if (!answer.accepted) {
        this.show(answer);
        return;
      }
      $('sheet').close();
      this.done(tr`${sizeOf(answer)} of ${this.name} are accepted`);
    } catch (error) {
      this.say(tr`Is ${this.name} accepted?`, tr`${error.message}. Look in the list for its orders before you send it again: all of them are there, or none.`);
    }
  }

  say(title, text, faults = []) {
    $('sheet-title').textContent = title;
    $('sheet-text').textContent = text;
    $('sheet-yes').hidden = true;
    $('sheet-faults').hidden = faults.length === 0;
    $('sheet-faults').tBodies[0].replaceChildren(...faults.map(({ line, column, text: what }) => make('tr', {},
      make('td', { className: 'right', textContent: line || '–' }), make('td', { textContent: column || '–' }), make('td', { textContent: what }))));
    if (!$('sheet').open) $('sheet').showModal();
  }
}

/** A file's text; an Error that says why it has none. */
async function textOf(file) {
  if (file.size > MOST) throw new Error(tr`it has ${number(file.size / 1e6, 1)} MB; ${MOST / 1e6} MB or less were expected: split it`);
  const bytes = await file.arrayBuffer();
  let text = '';
  try {
    text = new TextDecoder('utf-8', { fatal: true }).decode(bytes);
  } catch {
    throw new Error(tr`it is not in UTF-8; ${SAVE_AS}`);
  }
  if (text.includes('\0')) throw new Error(tr`it is not text; ${SAVE_AS}`);
  if (!text.trim()) throw new Error(tr`there is nothing in it`);
  return text;
}
