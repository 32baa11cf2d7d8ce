// SPDX-License-Identifier: Apache-2.0
// Events of a scenario, a line each: '2:30:00 close pick3'.

import { tr } from '../language/texts.js';

const PICKER = ['seconds_a_piece', 'pickers'];

const WORDS = {
  picker: ({ station, ...set }) => [station, ...PICKER.map((key) => set[key]).filter((part) => part !== undefined)],
  priority: ({ order, to }) => [order, to],
};

const VALUES = {
  picker: ([station, ...numbers]) => ({ station, ...Object.fromEntries(numbers.map((number, i) => [PICKER[i] ?? `value ${i + 1}`, plain(number)])) }),
  priority: (words) => ({ order: words.slice(0, -1).join(' '), to: plain(words.at(-1)) }),
  policy: ([role, ...name]) => ({ [role]: name.join(' ') }),
};

/** The lines that say events. */
export function linesOf(events = []) {
  return events.flatMap(({ at, for: duration, ...what }) => {
    const [[kind, value]] = Object.entries(what);
    if (kind === 'policy') return Object.entries(value).map(([role, name]) => [at, kind, role, name].join(' '));
    const words = WORDS[kind]?.(value) ?? [value];
    return [at, kind, ...words, ...(duration === undefined ? [] : ['for', duration])].join(' ');
  });
}

/** The events of lines; a line that says none gets an event that the server refuses. */
export function eventsOf(text) {
  return text.split('\n').map((line) => line.trim()).filter(Boolean).map((line) => {
    const [at, kind = '', ...words] = line.split(/\s+/);
    if (VALUES[kind] && words.length) return { at: plain(at), [kind]: VALUES[kind](words) };
    if (words.at(-2) === 'for') return { at: plain(at), [kind]: words.slice(0, -2).join(' '), for: plain(words.at(-1)) };
    return { at: plain(at), [kind]: words.join(' ') };
  });
}

/** A refusal of the server, with the event that it is about as a person counts. */
export const refusalOf = (text) => text.replace(/^events\[(\d+)\]\.?(\w*):?/, (_, i, key) => (
  tr`Event ${Number(i) + 1}: ${key === 'at' ? tr`its time` : key}`));

/** A number where a text is one. */
function plain(text) {
  return /^\d+(\.\d+)?$/.test(text) ? Number(text) : text;
}
