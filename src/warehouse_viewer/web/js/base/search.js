// SPDX-License-Identifier: Apache-2.0
// What a person types in search of something, and what it finds.

const MOST = 12; // found names shown

/** 'Robot 3' is kiva3; 'unit 12' is within storage_unit12. */
export function wanted(text) {
  return text.toLowerCase().replaceAll(/\s+/g, '').replace('robot', 'kiva');
}

/** Names with that text, the shortest first, so that item7 comes before item70. */
export function found(names, text) {
  if (!text) return [];
  const most = /\d$/.test(text) ? MOST : MOST / 2;
  return names.filter((name) => name.includes(text)).sort((a, b) => a.length - b.length).slice(0, most);
}

/** Indices of robots with that text in their names and that activity ('' = any), those that need help
 *  first, then by number. */
export function rowsOf({ scene: { robots }, activity }, text, filter) {
  return [...robots.keys()]
    .filter((i) => (filter === '' || activity[i] === Number(filter)) && (text === '' || `kiva${robots[i]}`.includes(text)))
    .sort((a, b) => activity[b] - activity[a] || robots[a] - robots[b]);
}
