// SPDX-License-Identifier: Apache-2.0
// Reads what viewer/protocol.py writes; the layout is described there.

export const VERSION = 4;
const UPDATE = 1, SCAN = 2, HEAD = 40, SCAN_HEAD = 32, WAYS_HEAD = 8, WAY_WORDS = 6;
export const ROBOT_WORDS = 7, BODY_WORDS = 9; // of four bytes, a row

/** {kind: 'update', tick, stamp, revision, robots, units, loose, scenery}, each a table; or
 *  {kind: 'scan', id, angleMin, angleStep, mount, ranges}, `mount` the laser's place on its robot; or
 *  {kind: 'ways', ways}, of each robot by its id {released, planned, waitsFor, goal}: points x y in a
 *  row, another's id or 0, [x, y] or null. */
export function decode(buffer) {
  const view = new DataView(buffer);
  const kind = view.getUint32(0, true);
  return kind === UPDATE ? update(buffer, view) : kind === SCAN ? scan(buffer, view) : ways(buffer, view);
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

function ways(buffer, view) {
  const count = view.getUint32(4, true);
  const [i32, f32] = [new Int32Array(buffer, WAYS_HEAD), new Float32Array(buffer, WAYS_HEAD)];
  const out = new Map();
  for (let row = 0, at = 0, from = WAY_WORDS * count; row < count; ++row, at += WAY_WORDS) {
    const [id, waitsFor, released, planned] = i32.subarray(at, at + 4);
    const [middle, to] = [from + 2 * released, from + 2 * (released + planned)];
    out.set(id, {
      released: f32.subarray(from, middle),
      planned: f32.subarray(middle, to),
      waitsFor,
      goal: Number.isFinite(f32[at + 4]) ? [...f32.subarray(at + 4, at + 6)] : null,
    });
    from = to;
  }
  return { kind: 'ways', ways: out };
}
