// SPDX-License-Identifier: Apache-2.0
// three.js, as the page loads it: what its modules use of it is in the module that stands for it.

import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import * as THREE from '/three/build/three.module.js';

const FOLDER = new URL('../../../src/warehouse_viewer/web/js/', import.meta.url);
const CONTROLS = '/usr/share/javascript/three/examples/jsm/controls/OrbitControls.js';
const text = (name) => readFileSync(new URL(name, FOLDER), 'utf8');
const offered = text('base/three.js').match(/export const \{([^}]*)\}/)[1].split(',').map((name) => name.trim()).filter(Boolean);

test('the module offers what the page and the controls use, and nothing that is not there', () => {
  const used = new Set();
  for (const path of readdirSync(FOLDER, { recursive: true }).filter((file) => file.endsWith('.js'))) {
    for (const [, what] of text(path).matchAll(/THREE\.([A-Z]\w+)/g)) used.add(what);
  }
  const [, controls] = readFileSync(CONTROLS, 'utf8').match(/import \{([^}]*)\} from "..\/..\/..\/build/);
  for (const name of controls.split(',')) used.add(name.trim());
  assert.deepEqual([...used].sort(), [...offered].sort());
  assert.deepEqual(offered.filter((name) => !(name in THREE)), []);
});
