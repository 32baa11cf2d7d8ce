// SPDX-License-Identifier: Apache-2.0
// The event log as a file.

import { get } from './api.js';
import { make } from './dom.js';

const MOST = 2000; // events that the server keeps
const COLUMNS = ['id', 'time', 'kind', 'command', 'model', 'other', 'text'];

/** Events as a table (RFC 4180), one a line beneath a line of names. */
export function csvOf(events) {
  const columns = COLUMNS.filter((name) => name !== 'command' || events.some((e) => 'command' in e));
  const rows = events.map((event) => columns.map((name) => field(event[name])));
  return [columns, ...rows].map((row) => `${row.join(',')}\r\n`).join('');
}

function field(value) {
  const text = String(value ?? '');
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

/** Saves what the server's journal holds; `kind` is csv or json. */
export async function saveEvents(kind) {
  const { events } = await get(`/events?limit=${MOST}`);
  const text = kind === 'csv' ? csvOf(events) : JSON.stringify(events, null, 1);
  download(`events.${kind}`, kind === 'csv' ? 'text/csv' : 'application/json', text);
}

function download(name, type, text) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  make('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
