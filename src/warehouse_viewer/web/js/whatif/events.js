// SPDX-License-Identifier: Apache-2.0
// Events of a scenario, a line each: '2:30:00 close pick3'.

const PICKER = ['seconds_a_piece', 'pickers'];

/** The lines that say events. */
export function linesOf(events = []) {
  return events.map(({ at, for: duration, ...what }) => {
    const [[kind, value]] = Object.entries(what);
    const words = kind === 'picker' ? [value.station, ...PICKER.map((key) => value[key]).filter((part) => part !== undefined)] : [value];
    return [at, kind, ...words, ...(duration === undefined ? [] : ['for', duration])].join(' ');
  });
}

/** The events of lines; a line that says none gets an event that the server refuses. */
export function eventsOf(text) {
  return text.split('\n').map((line) => line.trim()).filter(Boolean).map((line) => {
    const [at, kind = '', ...words] = line.split(/\s+/);
    if (kind === 'picker') {
      const [station, ...numbers] = words;
      return { at: plain(at), picker: { station, ...Object.fromEntries(numbers.map((number, i) => [PICKER[i] ?? `value ${i + 1}`, plain(number)])) } };
    }
    if (words.at(-2) === 'for') return { at: plain(at), [kind]: words.slice(0, -2).join(' '), for: plain(words.at(-1)) };
    return { at: plain(at), [kind]: words.join(' ') };
  });
}

/** A number where a text is one. */
function plain(text) {
  return /^\d+(\.\d+)?$/.test(text) ? Number(text) : text;
}
