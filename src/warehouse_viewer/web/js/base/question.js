// SPDX-License-Identifier: Apache-2.0
// Asks before something is done.

import { $, make, on } from './dom.js';
import { tr } from '../language/texts.js';

const FORM = `<form method="dialog">
  <h2 id="question-title"></h2><p id="question-text"></p>
  <div class="answers"><button id="question-no" value="">${tr`Cancel`}</button><button id="question-yes" value="yes" class="danger"></button></div>
</form>`;

if (globalThis.document) { // tests of a page's sums have none
  const dialog = make('dialog', { id: 'question', innerHTML: FORM });
  dialog.setAttribute('aria-labelledby', 'question-title');
  document.body.append(dialog);
}

/** Resolves to whether the person said yes. */
export async function confirmed(title, text, yes, no = tr`Cancel`) {
  $('question-title').textContent = title;
  $('question-text').textContent = text;
  $('question-yes').textContent = yes;
  $('question-no').textContent = no;
  return await ask($('question')) === 'yes';
}

let settle = () => {}; // the question that is open, or was last

/** Shows a <dialog> of a form; resolves to the value of the button that closed it, '' for none. */
export function ask(dialog) {
  settle('');
  dialog.returnValue = '';
  dialog.showModal();
  return new Promise((resolve) => {
    // News of a dialog's end may come after it was opened again.
    const close = () => dialog.open || settle(dialog.returnValue);
    settle = (value) => {
      dialog.removeEventListener('close', close);
      resolve(value);
    };
    on(dialog, 'close', close);
  });
}
