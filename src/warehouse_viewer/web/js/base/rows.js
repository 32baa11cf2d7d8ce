// SPDX-License-Identifier: Apache-2.0
// Lists that change by themselves while a person is in them: the focus stays where it was.

/** Shows rows in that order. Those that are there already stay, or are moved with the focus in them. */
export function arrange(list, rows) {
  if (list.children.length === rows.length && rows.every((row, i) => list.children[i] === row)) return;
  const focused = document.activeElement;
  list.replaceChildren(...rows);
  if (rows.some((row) => row.contains(focused))) focused.focus({ preventScroll: true });
}

/** Shows a row for each item: the row of the same key, or one that `make(item)` makes; `show(row, item)` says in it
 *  what the item is now. */
export function keepRows(list, items, { keyOf, make, show }) {
  const kept = new Map([...list.children].map((row) => [row.dataset.key, row]));
  arrange(list, items.map((item) => {
    const key = String(keyOf(item)), row = kept.get(key) ?? make(item);
    row.dataset.key = key;
    show(row, item);
    return row;
  }));
}

/** Disables buttons until `act` is done. One that had the focus has it again, unless a person went on. */
export async function whileBusy(buttons, act) {
  const focused = buttons.find((button) => button === document.activeElement);
  for (const button of buttons) button.disabled = true;
  try {
    return await act();
  } finally {
    for (const button of buttons) button.disabled = false;
    if (focused && (!document.activeElement || document.activeElement === document.body)) focused.focus({ preventScroll: true });
  }
}
