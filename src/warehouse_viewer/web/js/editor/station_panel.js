// SPDX-License-Identifier: Apache-2.0
// The stations: which there are, and the chosen one's name, kind and lane.

import { $, make, on } from '../base/dom.js';
import { tr } from '../language/texts.js';

export class StationPanel {
  constructor(editor) {
    this.editor = editor;
    on($('station-name'), 'change', () => this.rename());
    on($('station-kind'), 'change', () => this.alter((s) => { s.kind = $('station-kind').value; }));
    on($('station-lane'), 'click', () => this.alter((s, drawing) => {
      drawing.setLane(s, 'queue', []);
      drawing.setLane(s, 'exit', []);
    }));
    on($('station-remove'), 'click', () => this.alter((s, drawing) => drawing.remove(s)));
    editor.on('change', () => this.show());
    editor.on('state', () => this.show());
  }

  /** Changes the chosen station in the drawing that is kept from now on. */
  alter(act) {
    const { station, stationKey } = this.editor;
    if (!station) return;
    this.editor.change((drawing) => { act(drawing.stations.find((s) => s.key === stationKey), drawing); });
  }

  rename() {
    const name = $('station-name').value.trim(), { station, drawing } = this.editor;
    const isTaken = drawing.stations.some((s) => s !== station && s.name === name);
    if (!name || name.includes('/') || name.length > 60 || isTaken) {
      this.editor.say(isTaken ? tr`another station is called ${name}` : tr`a name of up to 60 characters without / was expected`, 'refused');
      $('station-name').value = station?.name ?? '';
    } else this.alter((s) => { s.name = name; });
  }

  show() {
    const { drawing, station, stationKey, lanesFound } = this.editor;
    const state = JSON.stringify([drawing.stations.map((s) => [s.key, s.name, s.kind]), stationKey]);
    if (state !== this.state) {
      $('stations').replaceChildren(...drawing.stations.map((s) => this.row(s, s === station)));
      this.state = state;
    }
    $('no-stations').hidden = drawing.stations.length > 0;
    $('station').hidden = !station;
    if (!station) return;
    if (document.activeElement !== $('station-name')) $('station-name').value = station.name;
    $('station-kind').value = station.kind;
    $('station-told').textContent = laneText(station, lanesFound[station.key]);
    $('station-lane').disabled = !station.queue.length && !station.exit.length;
  }

  row(station, isChosen) {
    const out = make('button', { type: 'button', click: () => this.editor.choose(isChosen ? null : station) },
      make('b', { textContent: station.key.length === 1 ? station.key : '•' }), make('span', { textContent: station.name }),
      make('small', { textContent: station.kind, className: 'dim' }));
    out.setAttribute('aria-pressed', String(isChosen));
    return make('li', {}, out);
  }
}

function laneText({ queue, exit }, lane) {
  if (queue.length && exit.length) return tr`queue of ${queue.length} and exit of ${exit.length} cells`;
  const drawn = queue.length ? tr`queue of ${queue.length} cells, no exit drawn` : exit.length ? tr`exit of ${exit.length} cells, no queue drawn` : tr`no lane drawn`;
  return lane ? tr`${drawn}: found by itself, dashed` : tr`${drawn}: choose queue or exit, then drag`;
}
