// SPDX-License-Identifier: Apache-2.0
// The colours of heat maps, and what they range over.

// Yellow to dark red, as in reports (ColorBrewer's YlOrRd).
export const STOPS = [[255, 255, 178], [254, 204, 92], [253, 141, 60], [240, 59, 32], [189, 0, 38]];

/** What of the values is shown as the most: all but a hundredth are below. */
export function topOf(values) {
  const some = values.filter((value) => value > 0).sort((a, b) => a - b);
  return some.length ? some[Math.floor(0.99 * (some.length - 1))] : 1;
}

/** A swatch for each colour. */
export function swatches() {
  return STOPS.map((stop) => {
    const out = document.createElement('i');
    out.style.background = `rgb(${stop})`;
    return out;
  });
}
