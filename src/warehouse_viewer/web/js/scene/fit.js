// SPDX-License-Identifier: Apache-2.0
// From where a camera just sees all of a floor.

/** The axes of a camera that looks down: `tilt` from the vertical, `heading` of the direction in
 *  which it looks over the floor [rad]. Unit vectors in world. */
export function axesOf(tilt, heading) {
  const [c, s] = [Math.cos(heading), Math.sin(heading)];
  const [down, along] = [-Math.cos(tilt), Math.sin(tilt)];
  return {
    right: [s, -c, 0],
    up: [-down * c, -down * s, along],
    ahead: [along * c, along * s, down],
  };
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Where a camera with these axes must be, [x, y, z], to have all points in its picture and as
 *  large as they go: `half` are the tangents of half its angles of view, [width, height]. */
export function positionFor(points, { right, up, ahead }, half) {
  // A point, in the camera's own axes, is in the picture where |x - cx| <= k (z - cz); the largest
  // cz for which both edges of an axis allow that is where they meet.
  const depth = points.map((p) => dot(p, ahead));
  const edges = [right, up].map((axis, i) => {
    const at = points.map((p) => dot(p, axis));
    return {
      at,
      low: Math.max(...at.map((x, j) => x - half[i] * depth[j])),
      high: Math.min(...at.map((x, j) => x + half[i] * depth[j])),
      k: half[i],
    };
  });
  const z = Math.min(...edges.map(({ low, high, k }) => (high - low) / (2 * k)));
  const far = depth.map((d) => d - z);
  const [x, y] = edges.map(({ at }) => middleOf(at, far));
  return [0, 1, 2].map((i) => x * right[i] + y * up[i] + z * ahead[i]);
}

/** Where along an axis a camera has as much room on one side of all points as on the other: `at` is where
 *  they are along the axis, `far` how far ahead. */
function middleOf(at, far) {
  let [low, high] = [Math.min(...at), Math.max(...at)];
  for (let halvings = 0; halvings < 50; ++halvings) {
    const middle = (low + high) / 2;
    const [left, right] = [-1, 1].map((side) => Math.max(...at.map((x, j) => side * (x - middle) / far[j])));
    [low, high] = right > left ? [middle, high] : [low, middle];
  }
  return (low + high) / 2;
}

/** The corners of a box on the floor: bounds [min x, max x, min y, max y] and height [m]. */
export function cornersOf([x0, x1, y0, y1], height) {
  return [x0, x1].flatMap((x) => [y0, y1].flatMap((y) => [[x, y, 0], [x, y, height]]));
}

/** Looking along y, or along x where all is seen larger so: {position, target, heading}, the target on
 *  the floor in the middle of the picture. */
export function seeAll(bounds, height, tilt, half) {
  const [x0, x1, y0, y1] = bounds, middle = [(x0 + x1) / 2, (y0 + y1) / 2, 0];
  const views = [Math.PI / 2, 0].map((heading) => {
    const axes = axesOf(tilt, heading);
    const position = positionFor(cornersOf(bounds, height), axes, half);
    const way = position[2] / -axes.ahead[2];
    const far = dot(middle, axes.ahead) - dot(position, axes.ahead);
    return { position, target: position.map((at, i) => at + way * axes.ahead[i]), way, far, heading };
  });
  return views[1].far < 0.8 * views[0].far ? views[1] : views[0];
}

/** Pixels a metre at which a floor that is seen from above, `heading` up, just fits into `free` [px,
 *  width and height]. */
export function scaleFor([x0, x1, y0, y1], heading, free) {
  const across = Math.abs(Math.cos(heading)) > 0.5 ? [y1 - y0, x1 - x0] : [x1 - x0, y1 - y0];
  return Math.min(...free.map((px, i) => px / across[i]));
}
