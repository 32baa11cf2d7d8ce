// SPDX-License-Identifier: Apache-2.0
// The handover note of a shift: the server's, in which a person writes what no program knows.

import { $, on } from '../base/dom.js';
import { send } from '../base/request.js';
import { tr } from '../language/texts.js';

let isReady = false;

/** Opens the note of now. */
export async function openHandover() {
  if (!isReady) addButtons();
  isReady = true;
  await read();
  $('handover').showModal();
}

async function read() {
  const answer = await send('GET', `/api/v1/handover.md?hours=${$('handover-hours').value}`);
  $('handover-text').value = await answer.text();
}

function addButtons() {
  on($('handover-hours'), 'change', () => read().catch((error) => say(error.message)));
  on($('handover-close'), 'click', () => $('handover').close());
  on($('handover-copy'), 'click', async () => {
    await navigator.clipboard.writeText($('handover-text').value).then(() => say(tr`copied`), () => say(tr`the browser does not let the page copy`));
  });
  on($('handover-save'), 'click', () => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([$('handover-text').value], { type: 'text/markdown' }));
    link.download = 'handover.md';
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
}

function say(text) {
  $('handover-told').textContent = text;
}
