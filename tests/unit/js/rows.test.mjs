// SPDX-License-Identifier: Apache-2.0
// Lists that change while a person is in them keep the focus, as far as a page without a browser can tell.

import assert from 'node:assert/strict';
import { beforeEach, test } from 'node:test';
import { arrange, keepRows, whileBusy } from '../../../src/warehouse_viewer/web/js/base/rows.js';

/** An element: what is taken out of its list loses the focus, as in browsers. */
class Element {
  constructor() {
    Object.assign(this, { children: [], dataset: {}, disabledNow: false });
  }

  set disabled(isDisabled) {
    this.disabledNow = isDisabled;
    if (isDisabled && document.activeElement === this) document.activeElement = document.body;
  }

  contains(other) {
    return other === this || this.children.some((child) => child.contains(other));
  }

  focus() {
    document.activeElement = this;
  }

  replaceChildren(...children) {
    if (this.contains(document.activeElement)) document.activeElement = document.body;
    this.children = children;
  }
}

let list;

beforeEach(() => {
  globalThis.document = { body: new Element() };
  document.activeElement = document.body;
  list = new Element();
});

function row() {
  const out = new Element();
  out.children = [new Element()]; // its link
  return out;
}

function show(ids) {
  keepRows(list, ids.map((id) => ({ id })), { keyOf: ({ id }) => id, make: row, show: (each, { id }) => { each.text = id; } });
}

test('a row that stays is the same one, with the focus', () => {
  show([1, 2, 3]);
  const [, second] = list.children;
  second.children[0].focus();
  show([2, 4]);
  assert.equal(list.children[0], second);
  assert.equal(document.activeElement, second.children[0]);
  assert.deepEqual(list.children.map(({ text }) => text), [2, 4]);
});

test('a list in the same order is left alone', () => {
  show([1, 2]);
  list.replaceChildren = () => assert.fail('it was replaced');
  show([1, 2]);
});

test('where the row with the focus goes, no other gets it', () => {
  const [gone, other] = [row(), row()];
  arrange(list, [gone, other]);
  gone.children[0].focus();
  arrange(list, [other]);
  assert.equal(document.activeElement, document.body);
});

test('a button that was pressed by a key has the focus again when its work is done', async () => {
  const button = new Element();
  button.focus();
  await assert.rejects(whileBusy([button], async () => {
    assert.equal(document.activeElement, document.body);
    throw new Error('refused');
  }), /refused/);
  assert.equal(document.activeElement, button);
  assert.equal(button.disabledNow, false);
});

test('a person who went on meanwhile is not called back', async () => {
  const [button, elsewhere] = [new Element(), new Element()];
  button.focus();
  await whileBusy([button], async () => elsewhere.focus());
  assert.equal(document.activeElement, elsewhere);
});
