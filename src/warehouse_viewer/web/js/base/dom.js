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
