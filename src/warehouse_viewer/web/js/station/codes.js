// SPDX-License-Identifier: Apache-2.0
// What a scanned code means.

/** Codes that stand for buttons, as /station/NAME/labels prints them. */
export const COMMANDS = ['ALL', 'UNDO', 'SHORT', 'DAMAGED', 'YES', 'NO'];
const COMMAND = new RegExp(`^CMD-(${COMMANDS.join('|')})$`, 'i');
const SHORT_TOTE = /^T0*(\d{1,4})$/i;

/** {kind: 'command', name}, {kind: 'tote', position}, {kind: 'other tote'} (of another station) or
 *  {kind: 'sku'}; `stations`: the names of all of them. */
export function meaningOf(code, station, stations) {
  const command = code.match(COMMAND);
  if (command) return { kind: 'command', name: command[1].toUpperCase() };
  const short = code.match(SHORT_TOTE);
  if (short) return { kind: 'tote', position: Number(short[1]) };
  const [, name, number] = code.match(/^(.+)-0*(\d{1,4})$/) ?? [];
  const isOf = (other) => name?.toLowerCase() === other.toLowerCase();
  if (name && isOf(station)) return { kind: 'tote', position: Number(number) };
  return { kind: name && stations.some(isOf) ? 'other tote' : 'sku' };
}
