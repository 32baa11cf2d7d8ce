// SPDX-License-Identifier: Apache-2.0
// Signs at stations: their names, how many robots queue there, and whether one waits for a person or for
// a unit that does not come.

import * as THREE from '/three/build/three.module.js';
import { tr } from '../language/texts.js';
import { STILL } from './backdrop.js';
import { Changes } from '../base/changes.js';
import { apart, namedStations } from './labelled.js';

const TALL = 2.4, THICK = 0.06; // of a post [m]
const SOON = 10, LONG = 60; // waiting for a person from which a sign is shown, and is red [s]
const NARROW = globalThis.matchMedia?.('(max-width: 760px)'); // as in floor.css: signs would hide robots
const LARGE = 18; // from which a sign has room on a narrow page [px/m]
const POST = { dark: 0x6b7889, light: 0x8d99a8 };

export class Signs {
  /** `takeAlarms(alarms)` gets the server's alarms by cause, null where none are known. */
  constructor(stage, world, takeAlarms) {
    Object.assign(this, { stage, world, takeAlarms, queues: {}, stations: new Map(), changes: null, posts: null });
  }

  /** New posts, for the World's scene. */
  build(theme) {
    if (this.posts) {
      this.stage.scene.remove(this.posts);
      this.posts.geometry.dispose();
    }
    const { stations } = this.world.scene;
    this.posts = new THREE.InstancedMesh(new THREE.BoxBufferGeometry(THICK, THICK, TALL),
      new THREE.MeshBasicMaterial(), Math.max(1, stations.length));
    Object.assign(this.posts, { frustumCulled: false, count: stations.length });
    const matrix = new THREE.Matrix4();
    stations.forEach(({ x, y }, i) => this.posts.setMatrixAt(i, matrix.makeTranslation(x, y, TALL / 2)));
    this.posts.layers.set(STILL);
    this.stage.scene.add(this.posts);
    this.setTheme(theme);
  }

  setTheme(theme) {
    this.posts?.material.color.set(POST[theme]);
    this.stage.renew();
  }

  /** Takes the server's state of the fleet; null: none runs, and nothing more is known of stations. Those
   *  of now are asked for; `past`: those that were then. */
  take(fleet, past = null) {
    this.queues = fleet?.queues ?? {};
    this.follow(Boolean(fleet) && !past);
    if (past) this.showStations(past);
  }

  follow(isOn) {
    if (isOn === Boolean(this.changes)) return;
    this.changes?.close();
    this.stations.clear();
    if (!isOn) this.takeAlarms(null);
    this.changes = isOn ? new Changes(['stations', 'alarms'], {
      alarms: ({ alarms }) => this.takeAlarms(alarms),
      shift: ({ runs }) => runs || this.stations.clear(),
      stations: ({ stations }) => this.showStations(stations),
    }) : null;
  }

  showStations(stations) {
    this.stations = new Map(stations.map((station) => [station.name, station]));
  }

  /** [{text, kind, at, note}] for the Labels, of stations whose signs have room; the note is beside the text. */
  labels(view) {
    return apart(namedStations(this.world.scene.stations, view).map(({ name, x, y }) => {
      const at = [x, y, view.isParallel ? 0 : TALL];
      const sign = signOf(this.queues[name], this.stations.get(name));
      const isSmall = NARROW?.matches && sign.kind === 'sign' && view.scaleAt(x, y, 0, 0.5) < LARGE;
      return { text: name, at, pixel: this.stage.pixelOf(...at), ...isSmall ? { kind: 'sign small', note: '' } : sign };
    }));
  }
}

/** {kind, note} of a sign: robots in its queue, and what a person has to know. */
export function signOf(queue, station) {
  const count = queue ? String(queue) : '';
  if (station && !station.open) return { kind: 'sign', note: [count, tr`closed`].filter(Boolean).join(' · ') };
  const waits = Math.floor(station?.waiting ?? 0);
  if (waits < SOON && station?.activity === 'WAITING') return { kind: 'sign waiting', note: [count, tr`no unit`].filter(Boolean).join(' · ') };
  if (waits < SOON) return { kind: 'sign', note: count };
  const text = waits < LONG ? tr`${waits} s` : tr`${Math.floor(waits / 60)} min`;
  return { kind: `sign ${waits < LONG ? 'waiting' : 'needs-help'}`, note: [count, text].filter(Boolean).join(' · ') };
}
