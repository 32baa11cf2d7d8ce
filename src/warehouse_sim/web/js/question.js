// SPDX-License-Identifier: Apache-2.0
// Asks before something is done.

import { $, on } from './dom.js';

/** Resolves to whether the person said yes. */
export async function confirmed(title, text, yes) {
  $('question-title').textContent = title;
  $('question-text').textContent = text;
  $('question-yes').textContent = yes;
  return await ask($('question')) === 'yes';
}

/** Shows a <dialog> of a form; resolves to the value of the button that closed it, '' for none. */
export function ask(dialog) {
  dialog.returnValue = '';
  dialog.showModal();
  return new Promise((resolve) => {
    const close = () => {
      if (dialog.open) return; // the news is of the time before, and late
      dialog.removeEventListener('close', close);
      resolve(dialog.returnValue);
    };
    on(dialog, 'close', close);
  });
}
