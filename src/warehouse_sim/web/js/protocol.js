// SPDX-License-Identifier: Apache-2.0
// Reads what viewer/protocol.py writes; the layout is described there.

export const VERSION = 2;
const UPDATE = 1, HEAD = 40, SCAN_HEAD = 32;
export const ROBOT_WORDS = 6, BODY_WORDS = 9; // of four bytes, a row

/** {kind: 'update', tick, stamp, revision, robots, units, loose, scenery}, each a table; or
 *  {kind: 'scan', id, angleMin, angleStep, mount, ranges}, `mount` the laser's place on its robot. */
export function decode(buffer) {
  const view = new DataView(buffer);
  return view.getUint32(0, true) === UPDATE ? update(buffer, view) : scan(buffer, view);
}

function update(buffer, view) {
  const out = {
    kind: 'update',
    tick: view.getUint32(4, true),
    stamp: view.getFloat64(8, true),
    revision: view.getUint32(16, true),
  };
  let at = HEAD;
  ['robots', 'units', 'loose', 'scenery'].forEach((name, i) => {
    const words = i === 0 ? ROBOT_WORDS : BODY_WORDS;
    const count = view.getUint32(20 + 4 * i, true);
    out[name] = table(buffer, at, count, words);
    at += 4 * words * count;
  });
  return out;
}

/** The same rows as floats, integers and bytes; row i begins at word i * words. */
function table(buffer, at, count, words) {
  const length = count * words;
  return {
    count,
    words,
    f32: new Float32Array(buffer, at, length),
    i32: new Int32Array(buffer, at, length),
    u8: new Uint8Array(buffer, at, 4 * length),
  };
}

function scan(buffer, view) {
  return {
    kind: 'scan',
    id: view.getUint32(4, true),
    angleMin: view.getFloat32(8, true),
    angleStep: view.getFloat32(12, true),
    mount: [...new Float32Array(buffer, 16, 4)],
    ranges: new Float32Array(buffer, SCAN_HEAD),
  };
}
