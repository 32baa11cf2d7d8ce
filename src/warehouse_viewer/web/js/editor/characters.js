// SPDX-License-Identifier: Apache-2.0
// The characters of a layout file, as doc/how-to/editor.md lists them.

import { tr } from '../language/texts.js';

export const NOTHING = ' ', FLOOR = '.', PLACE = 's';
export const NEXT_STATION = 'A–Z'; // as a brush: a station with the next letter that is free

/** The characters in the order of the palette; `look` names the colour, --cell-… of palette.py. */
export const CHARACTERS = [
  { char: '.', word: tr`floor`, hint: tr`floor, driven any way`, look: 'floor' },
  { char: '>', word: tr`one way right`, hint: tr`one-way street to the right`, look: 'street' },
  { char: '<', word: tr`one way left`, hint: tr`one-way street to the left`, look: 'street' },
  { char: '^', word: tr`one way up`, hint: tr`one-way street up`, look: 'street' },
  { char: 'v', word: tr`one way down`, hint: tr`one-way street down`, look: 'street' },
  { char: '-', word: tr`both ways ↔`, hint: tr`street driven both ways, left and right`, look: 'street' },
  { char: '|', word: tr`both ways ↕`, hint: tr`street driven both ways, up and down`, look: 'street' },
  { char: 's', word: tr`storage place`, hint: tr`a storage unit can stand here`, look: 'storage' },
  { char: 'p', word: tr`parking`, hint: tr`robots without work wait here`, look: 'parking' },
  { char: 'c', word: tr`charging`, hint: tr`a charging place, also parking`, look: 'charging' },
  { char: NEXT_STATION, word: tr`station`, hint: tr`where units are served; the next free letter`, look: 'service' },
  { char: '=', word: tr`conveyor belt`, hint: tr`a conveyor belt, beside a picking station`, look: 'belt' },
  { char: '#', word: tr`wall`, hint: tr`a wall or pillar, a metre high`, look: 'wall' },
  { char: 'x', word: tr`keep out`, hint: tr`floor where no robot drives`, look: 'keep_out' },
  { char: ' ', word: tr`no floor`, hint: tr`erases`, look: 'nothing', key: 'space' },
];

const LOOKS = Object.fromEntries(CHARACTERS.map(({ char, look }) => [char, look]));
const CLOSED = new Set(['#', '=', ' ', 'x']);
const KEPT = new Set(['s', 'p', 'c']); // passable, but no street

export const isLetter = (char) => char.length === 1 && char >= 'A' && char <= 'Z';
export const isCharacter = (char) => char in LOOKS || isLetter(char);
export const isPassable = (char) => !CLOSED.has(char);
export const isStreet = (char) => !CLOSED.has(char) && !KEPT.has(char);
export const lookOf = (char) => LOOKS[char] ?? 'service';

/** Headings [dx, dy] in which an arrow points; none for others. */
export const POINTS = {
  '>': [[1, 0]], '<': [[-1, 0]], '^': [[0, 1]], 'v': [[0, -1]],
  '-': [[1, 0], [-1, 0]], '|': [[0, 1], [0, -1]],
};

const swapped = (pairs) => Object.fromEntries(pairs.flatMap(([a, b]) => [[a, b], [b, a]]));
/** What an arrow becomes in a mirror, and by a quarter turn to the left. */
export const MIRRORED = { x: swapped(['<>']), y: swapped(['^v']) };
export const TURNED = { '>': '^', '^': '<', '<': 'v', 'v': '>', '-': '|', '|': '-' };
