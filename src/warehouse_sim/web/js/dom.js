// SPDX-License-Identifier: Apache-2.0

export const $ = (id) => document.getElementById(id);

/** An element with properties and children. */
export function make(tag, properties = {}, ...children) {
  const out = Object.assign(document.createElement(tag), properties);
  out.append(...children);
  return out;
}

export function setIcon(button, name) {
  button.querySelector('use').setAttribute('href', `/web/icons.svg#${name}`);
}

export function press(button, on) {
  button.setAttribute('aria-pressed', String(on));
}

export const isPressed = (button) => button.getAttribute('aria-pressed') === 'true';
