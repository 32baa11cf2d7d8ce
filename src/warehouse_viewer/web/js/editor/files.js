// SPDX-License-Identifier: Apache-2.0
// Opens, saves and downloads files, and generates new ones.

import { $, make, on } from '../base/dom.js';
import { ask as question, confirmed } from '../base/question.js';
import { ask as request, send } from '../base/request.js';
import { ROOT } from '../base/root.js';
import { tr } from '../language/texts.js';
import { ask } from './server.js';
import { textOf } from './text.js';

const COUNTS = ['robots', 'units', 'items', 'stations'];
const MOST = 5e6; // [bytes] of a file

export class Files {
  constructor(editor, about) {
    Object.assign(this, { editor, about });
    on($('open'), 'click', () => $('file').click());
    on($('file'), 'change', () => this.open($('file').files));
    on($('save'), 'click', () => this.save());
    on($('new'), 'click', () => this.create());
    on(window, 'dragover', (event) => event.preventDefault());
    on(window, 'drop', (event) => {
      event.preventDefault();
      if (event.dataTransfer?.files.length) this.open(event.dataTransfer.files);
    });
    this.prepare();
  }

  prepare() {
    const sizes = this.about.presets;
    $('new-size').append(...Object.keys(sizes).map((name) => make('option', { value: name, textContent: name })),
      make('option', { value: '', textContent: tr`own counts` }));
    on($('new-size'), 'change', () => this.showCounts());
    for (const what of COUNTS) {
      $(`new-${what}`).max = this.about.limits[what === 'units' ? 'shelves' : what];
      on($(`new-${what}`), 'input', () => { $('new-size').value = ''; });
    }
    this.showCounts();
    const { file, saves } = this.about;
    $('save').title = saves ? tr`Save to ${file} (Ctrl+S)` : tr`Download as NAME.layout.yaml (Ctrl+S)`;
  }

  showCounts() {
    const preset = this.about.presets[$('new-size').value];
    for (const what of COUNTS) if (preset) $(`new-${what}`).value = preset[what];
  }

  async open(list) {
    const files = [...list];
    $('file').value = '';
    await this.attempt(async () => {
      if (files.some((file) => file.size > MOST)) throw new Error(tr`a file of up to 5 MB was expected`);
      const contents = await Promise.all(files.map(async (file) => [file.name, await base64(file)]));
      const { drawing, told: notes } = await ask('POST', '/read', { files: Object.fromEntries(contents) });
      this.editor.open(drawing);
      showLost(notes);
      this.editor.say(tr`Opened ${files.map((f) => f.name).join(', ')}`, 'done');
    });
  }

  /** Opens the layout that the address names, which a search on the page /whatif found. */
  async openDesigned() {
    const query = new URLSearchParams(location.search), design = query.get('design'), layout = query.get('layout');
    if (!design || !layout) return;
    history.replaceState(null, '', location.pathname);
    await this.attempt(async () => {
      const answer = await send('GET', `/whatif/designs/${encodeURIComponent(design)}/layouts/${encodeURIComponent(layout)}`);
      await this.open([new File([await answer.text()], layout)]);
    });
  }

  async save() {
    const { text } = textOf(this.editor.drawing);
    if (!this.about.saves) {
      this.download(text);
      return;
    }
    await this.attempt(async () => this.editor.say((await ask('PUT', '/file', { text })).message, 'done'));
  }

  download(text) {
    const name = fileNameOf(this.editor.drawing);
    const href = URL.createObjectURL(new Blob([text], { type: 'text/yaml' }));
    make('a', { href, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(href), 10000);
    this.editor.say(tr`Downloaded ${name}`, 'done');
  }

  async create() {
    const answer = await question($('creator'));
    if (answer === 'empty') this.editor.open(null);
    else if (answer === 'yes') {
      const counts = Object.fromEntries(COUNTS.map((what) => [what, $(`new-${what}`).valueAsNumber || 0]));
      await this.attempt(async () => this.editor.open(await ask('POST', '/new', counts)));
    }
  }

  async attempt(act) {
    try {
      await act();
    } catch (error) {
      this.editor.say(error.message, 'refused');
    }
  }
}

/** Lists what could not be carried over from a file of another format. */
export function showLost(notes) {
  if (!notes?.length) return;
  $('lost').replaceChildren(...notes.map((text) => make('li', { textContent: text })));
  $('loser').showModal();
}

/** Builds the drawing in place of the warehouse that runs. */
export async function build(editor, post) {
  if (isRefused(editor)) return;
  const name = editor.drawing.name || tr`this layout`;
  const isSure = await confirmed(tr`Build ${name}?`, tr`It replaces the running warehouse. The robots and the stock there are lost.`, tr`Build`);
  if (!isSure) return;
  try {
    editor.say(tr`building …`);
    const { message } = await post('/warehouse', { layout: textOf(editor.drawing).text });
    editor.say(message || tr`built`, 'done');
  } catch (error) {
    editor.say(error.message, 'refused');
  }
}

/** Starts a warehouse of the drawing in the hub, with a shift, and goes to where it is listed. */
export async function start(editor) {
  if (isRefused(editor)) return;
  try {
    const wished = editor.drawing.name.toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-|-$/g, '').slice(0, 30);
    const taken = (await request('GET', '/api/v1/simulations')).simulations.map(({ name }) => name);
    const name = free(wished || 'drawing', taken);
    await request('POST', '/api/v1/simulations', { name, shift: true, layout: textOf(editor.drawing).text });
    location.assign('/');
  } catch (error) {
    editor.say(error.message, 'refused');
  }
}

function free(base, taken) {
  for (let i = 1; ; i++) {
    const name = i === 1 ? base : `${base}-${i}`;
    if (!taken.includes(name)) return name;
  }
}

/** Whether there is nothing to build or to compare yet, or what has faults; says so. */
function isRefused({ bounds, faults, say }) {
  if (!bounds) say(tr`nothing is drawn yet: draw a warehouse, or begin with New`, 'refused');
  else if (faults.length) say(tr`mend its faults first: ${faults[0].text}`, 'refused');
  return !bounds || faults.length > 0;
}

/** Hands the drawing to the page /whatif as a layout to be compared, and goes there. */
export async function compare(editor) {
  if (isRefused(editor)) return;
  try {
    const name = fileNameOf(editor.drawing);
    const { name: kept } = await request('POST', '/whatif/layouts', { name, text: textOf(editor.drawing).text });
    location.assign(`${ROOT}/whatif?layout=${encodeURIComponent(kept)}`);
  } catch (error) {
    editor.say(error.message, 'refused');
  }
}

const fileNameOf = ({ name }) => `${name.replace(/[^\w.-]+/g, '_').replace(/^[^a-z0-9]+/i, '') || 'warehouse'}.layout.yaml`;

async function base64(file) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  let text = '';
  for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
  return btoa(text);
}
