// SPDX-License-Identifier: Apache-2.0
// What a search for a layout is about, in words and as the server takes it.

import { tr } from '../language/texts.js';
import { layoutOf, number } from './words.js';

export const EDGES = /^\d+x\d+$/;

/** {file, times} of a demand as the server takes it. */
export function demandOf(demand) {
  const [file, times = '1'] = demand.split('*');
  return { file, times: Number(times) };
}

export const demandText = ({ file, times }) => (file && times !== 1 ? `${file}*${times}` : file);

/** The edges in a person's words, as '40x30'; the words where there are none. */
export function edgesOf(text) {
  const edges = /^\s*(\d+)\s*[x×*, ]\s*(\d+)\s*$/i.exec(text);
  return edges ? `${edges[1]}x${edges[2]}` : text.trim();
}

/** What a search is about, in a line. */
export function describeDesign({ building, demand, late, cpu_hours: hours, seed }) {
  return [layoutOf(building), demand.replace('*', ' × '), tr`${number(100 * late, 2).replace(/\.?0+$/, '')} % may be late`, tr`${hours} CPU h`, tr`seed ${seed}`].join(' · ');
}
