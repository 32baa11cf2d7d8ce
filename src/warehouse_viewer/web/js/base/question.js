// SPDX-License-Identifier: Apache-2.0
// Asks before something is done.

import { $, on } from './dom.js';

/** Resolves to whether the person said yes. */
export async function confirmed(title, text, yes, no = 'Cancel') {
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
