// SPDX-License-Identifier: Apache-2.0

import { tr } from '../language/texts.js';

export const $ = (id) => document.getElementById(id);

/** Calls the handler at each such event. What it returns means nothing; to an `onkeydown` a false
 *  would mean that the key types nothing. */
export function on(target, type, handler) {
  target.addEventListener(type, handler);
}

/** The value of a variable of the style sheets, such as 'moving'. */
export function token(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Calls `act` whenever the colours are others: dark or light. */
export function onTheme(act) {
  new MutationObserver(act).observe(document.documentElement, { attributeFilter: ['data-theme'] });
}

/** An element with properties and children; `click` is called when it is clicked. */
export function make(tag, { click, ...properties } = {}, ...children) {
  const out = Object.assign(document.createElement(tag), properties);
  out.append(...children);
  if (click) on(out, 'click', click);
  return out;
}

/** Sets a text; one that is the same already would be painted again. */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

export function setIcon(button, name) {
  button.querySelector('use').setAttribute('href', `/web/icons.svg#${name}`);
}

export function press(button, down) {
  button.setAttribute('aria-pressed', String(down));
}

export const isPressed = (button) => button.getAttribute('aria-pressed') === 'true';

let withheld = ''; // why no button that commands is enabled

/** Enables no button that commands from now on, for a reason; '': it is over. */
export function withhold(reason) {
  withheld = reason;
}

/** Enables a button that commands, or says in its title what it lacks. */
export function enable(button, lack, titled = button) {
  const why = withheld || lack;
  titled.dataset.title ??= titled.title;
  button.disabled = Boolean(why);
  button.dataset.why = why || '';
  titled.title = why ? tr`${titled.dataset.title} – not now: ${why}` : titled.dataset.title;
}

// Lists that change by themselves while a person is in them: the focus stays where it was.

/** Shows rows in that order. Those that are there already stay, or are moved with the focus in them. */
export function arrange(list, rows) {
  if (list.children.length === rows.length && rows.every((row, i) => list.children[i] === row)) return;
  const focused = document.activeElement;
  list.replaceChildren(...rows);
  if (rows.some((row) => row.contains(focused))) focused.focus({ preventScroll: true });
}

/** Shows a row for each item: the row of the same key, or one that `create(item)` makes; `show(row, item)` says in it
 *  what the item is now. */
export function keepRows(list, items, { keyOf, create, show }) {
  const kept = new Map([...list.children].map((row) => [row.dataset.key, row]));
  arrange(list, items.map((item) => {
    const key = String(keyOf(item)), row = kept.get(key) ?? create(item);
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
