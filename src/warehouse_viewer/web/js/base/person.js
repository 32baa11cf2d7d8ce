// SPDX-License-Identifier: Apache-2.0
// The name of the person in front of the page, kept in the browser.

import { $, make, on } from './dom.js';
import { tr } from '../language/texts.js';

const FORM = `<form method="dialog">
  <h2 id="who-title">${tr`Who are you?`}</h2>
  <p class="dim">${tr`Others see this name beside the alarms that you take care of. It stays in this browser.`}</p>
  <label>${tr`Name`} <input id="who-name" maxlength="60" autocomplete="nickname"></label>
  <div class="answers"><button value="">${tr`Cancel`}</button><button value="yes" class="strong">${tr`Keep`}</button></div>
</form>`;

/** The name that is kept here; '': none is. */
export const knownPerson = () => localStorage.getItem('person') ?? '';

/** The name; asks for it if there is none yet, or `again`. '': the person gives none. */
export async function personOf(again = false) {
  const kept = knownPerson();
  if (kept && !again) return kept;
  if (!$('who')) addDialog();
  const dialog = $('who'), name = $('who-name');
  name.value = kept;
  dialog.returnValue = '';
  dialog.showModal();
  name.focus();
  await new Promise((resolve) => { on(dialog, 'close', resolve); });
  if (dialog.returnValue !== 'yes') return kept;
  const typed = name.value.trim();
  localStorage.setItem('person', typed);
  return typed;
}

function addDialog() {
  const dialog = make('dialog', { id: 'who', innerHTML: FORM });
  dialog.setAttribute('aria-labelledby', 'who-title');
  document.body.append(dialog);
  on($('who-name'), 'keydown', onKey);
}

/** Enter keeps the name: the form's first button is another. */
function onKey(event) {
  if (event.key !== 'Enter') return;
  event.preventDefault();
  $('who').close('yes');
}
