// SPDX-License-Identifier: Apache-2.0
// Which scenarios are compared, the reference first: kept in the address, which can be sent.

import { on } from '../base/dom.js';

const KEY = '#compare=';

/** The names in an address's hash. */
export function namesOf(hash) {
  if (!hash.startsWith(KEY)) return [];
  return hash.slice(KEY.length).split(',').filter(Boolean).map((part) => {
    try {
      return decodeURIComponent(part);
    } catch {
      return part;
    }
  });
}

export const hashOf = (names) => KEY + names.map(encodeURIComponent).join(',');

export class Picks {
  constructor(most, changed) {
    Object.assign(this, { most, changed });
    this.names = namesOf(location.hash);
    on(window, 'hashchange', () => {
      this.names = namesOf(location.hash);
      this.changed();
    });
  }

  set(names) {
    this.names = names;
    history.replaceState(null, '', names.length ? hashOf(names) : location.pathname);
    this.changed();
  }

  has(name) {
    return this.names.includes(name);
  }

  /** Picks a scenario, or no more; false where there are enough. */
  toggle(name) {
    const isNew = !this.has(name);
    if (isNew && this.names.length >= this.most) return false;
    this.set(isNew ? [...this.names, name] : this.names.filter((other) => other !== name));
    return true;
  }

  makeFirst(name) {
    this.set([name, ...this.names.filter((other) => other !== name)]);
  }

  rename(from, to) {
    if (this.has(from)) this.set(this.names.map((name) => (name === from ? to : name)));
  }

  /** Forgets those that are gone. */
  keep(known) {
    const left = this.names.filter((name) => known.includes(name));
    if (left.length < this.names.length) this.set(left);
  }
}
