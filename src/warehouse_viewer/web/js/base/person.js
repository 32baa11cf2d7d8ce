// SPDX-License-Identifier: Apache-2.0
// The name of the person in front of the page, kept in the browser.

import { $, on } from './dom.js';

/** The name; asks for it if there is none yet, or `again`. '': the person gives none. */
export async function personOf(again = false) {
  const kept = localStorage.getItem('person') ?? '';
  if (kept && !again) return kept;
  const dialog = $('who'), name = $('who-name');
  name.value = kept;
  dialog.returnValue = '';
  dialog.showModal();
  name.focus();
  on(name, 'keydown', onKey); // once: a listener that is there is not added again
  await new Promise((resolve) => { on(dialog, 'close', resolve); });
  if (dialog.returnValue !== 'yes') return kept;
  const typed = name.value.trim();
  localStorage.setItem('person', typed);
  return typed;
}

/** Enter keeps the name: the form's first button is another. */
function onKey(event) {
  if (event.key !== 'Enter') return;
  event.preventDefault();
  $('who').close('yes');
}
