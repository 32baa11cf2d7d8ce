// SPDX-License-Identifier: Apache-2.0
// The page /layout.

import { post, reloadIfLockedOut } from '../base/api.js';
import { $, enable, make, on, onTheme } from '../base/dom.js';
import { tr } from '../language/texts.js';
import { Checker } from './checker.js';
import { Editor } from './editor.js';
import { build, compare, Files, showLost, start } from './files.js';
import { Keyboard, KEYS } from './keyboard.js';
import { Palette } from './palette.js';
import { Panel } from './panel.js';
import { Pointer } from './pointer.js';
import { ask } from './server.js';
import { StationPanel } from './station_panel.js';
import { Store } from './store.js';
import { Trial } from './trial.js';

const STAYS = 6000; // [ms] that a word to the person stays
const NONE = { presets: {}, limits: {}, builds: false, compares: false, starts: false, file: '', saves: false };

function say(text, kind = '') {
  Object.assign($('said'), { textContent: text, hidden: false });
  $('said').dataset.kind = kind;
  clearTimeout(say.timer);
  say.timer = setTimeout(() => { $('said').hidden = true; }, STAYS);
}

async function aboutServer() {
  try {
    return await ask('GET', '/about');
  } catch (error) {
    reloadIfLockedOut();
    say(error.message, 'refused');
    return NONE;
  }
}

/** What was drawn here last comes back; else the file that is edited. */
function begin(editor, store, about) {
  const kept = store.kept();
  editor.open(kept?.drawing ?? about.drawing ?? null, true);
  if (about.error) say(about.error, 'refused');
  if (!kept) showLost(about.told);
  if (!kept || (about.drawing && Store.isSame(kept.drawing, about.drawing))) return;
  const when = new Date(kept.time).toLocaleString([], { dateStyle: 'medium', timeStyle: 'short' });
  $('notice-text').textContent = tr`Your last drawing is back, from ${when}.`;
  $('notice-button').textContent = about.drawing ? tr`Take the file instead` : tr`Start with empty paper`;
  $('notice').hidden = false;
  on($('notice-button'), 'click', () => {
    editor.open(about.drawing ?? null);
    $('notice').hidden = true;
  });
  on($('notice-close'), 'click', () => { $('notice').hidden = true; });
}

function follow(editor) {
  onTheme(() => editor.dress());
  editor.dress();
  editor.on('change', () => { $('hint').hidden = Boolean(editor.bounds); });
}

function help() {
  const more = { ...Object.fromEntries(Object.entries(KEYS).map(([key, id]) => [key, $(id).title || $(id).textContent])),
    'arrows': tr`move the cursor; with shift they mark an area`, 'enter': tr`draw at the cursor; a second time ends a shape`,
    'delete': tr`erase what is marked`, 'escape': tr`give up`, 'ctrl+z, ctrl+y': tr`undo, redo`, 'ctrl+c, x, v, a': tr`copy, cut, paste, mark all`,
    'A … Z': tr`a station with that letter`, 'wheel': tr`zoom; the right button moves the paper` };
  $('keys').append(...Object.entries(more).flatMap(([key, meaning]) => [
    make('dt', {}, make('kbd', { textContent: key })), make('dd', { textContent: meaning.replace(/ \(.*\)$/, '') })]));
  on($('help'), 'click', () => $('helper').showModal());
  on($('helper-close'), 'click', () => $('helper').close());
}

async function main() {
  const editor = new Editor(say), about = await aboutServer(), store = new Store(editor, about.file);
  const parts = { palette: new Palette(editor), panel: new Panel(editor), stations: new StationPanel(editor),
    checker: new Checker(editor), pointer: new Pointer(editor, $('overlay')), keyboard: new Keyboard(editor),
    files: new Files(editor, about), trial: new Trial(editor) };
  help();
  follow(editor);
  begin(editor, store, about);
  await parts.files.openDesigned();
  store.follow();
  enable($('build'), about.builds ? '' : tr`no warehouse runs here; roslaunch warehouse_sim warehouse.launch layout:=FILE builds the saved file`);
  $('start').hidden = !about.starts;
  $('build').hidden = about.starts;
  on($('start'), 'click', () => start(editor));
  $('compare').hidden = !about.compares;
  on($('compare'), 'click', () => compare(editor));
  on($('build'), 'click', () => build(editor, post));
  window.page = { editor, store, ...parts };
}

main();
