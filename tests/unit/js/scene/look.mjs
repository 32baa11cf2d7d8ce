// SPDX-License-Identifier: Apache-2.0
// Scenes for tests, as the server tells them.

export const AT = (x = 0, y = 0, z = 0) => [x, y, z, 0, 0, 0, 1];
export const QUARTER = [Math.SQRT1_2, 0, 0, Math.SQRT1_2]; // about x

const box = (size, pose, colour = [0.5, 0.5, 0.5, 1]) => ({ kind: 0, pose, size, colour });

/** A robot with wheels of 0.1 m, 0.52 m apart. */
export const ROBOT = [
  { name: 'chassis', pose: AT(), shapes: [box([0.7, 0.6, 0.3], AT(0, 0, 0.2)), box([0.1, 0.1, 0.1], AT(0.3))] },
  ...[0.26, -0.26].map((y, i) => ({ name: ['left_wheel', 'right_wheel'][i], pose: AT(0, y, 0.1),
    shapes: [{ kind: 2, pose: [0, 0, 0, ...QUARTER], size: [0.2, 0.2, 0.05], colour: [0, 0, 0, 1] }] })),
];

export const UNIT = [{ name: 'shelf', pose: AT(), shapes: [box([0.8, 0.8, 1.4], AT(0, 0, 1.1))] }];

/** Two robots, two storage units with an item each. */
export function scene() {
  return {
    revision: 1, robots: [1, 7], units: ['storage_unit3', 'storage_unit12'], items: ['item1', 'item2'],
    item_unit: [0, 1], item_pose: [...AT(0.2, 0, 0.5), ...AT(0.2, 0, 0.5)],
    fallen_item: [], fallen_from: [], floor: [-5, 5, -5, 5], grid: 1,
    looks: [ROBOT, UNIT], robot_look: 0, unit_look: 1, item_look: -1, scenery: ['conveyor_belt1'],
    scenery_look: [1],
  };
}

/** A table of an update, from rows of numbers; `integers` are the columns that hold some. */
export function table(rows, words, integers) {
  const f32 = new Float32Array(rows.flat());
  const i32 = new Int32Array(f32.buffer);
  rows.forEach((row, r) => integers.forEach((c) => { i32[r * words + c] = row[c]; }));
  return { count: rows.length, words, f32, i32, u8: new Uint8Array(f32.buffer) };
}
