// SPDX-License-Identifier: Apache-2.0
// What a station's screen keeps on this device, by names: it is there again after a reload.

export class Shelf {
  constructor(prefix, storage = localStorage) {
    Object.assign(this, { prefix, storage });
  }

  read(name) {
    try {
      return JSON.parse(this.storage.getItem(this.prefix + name));
    } catch {
      return null;
    }
  }

  /** What can't be kept is lost with the page alone. */
  write(name, value) {
    try {
      this.storage.setItem(this.prefix + name, JSON.stringify(value));
    } catch (error) {
      console.warn(`${name} is not kept: ${error.message}`);
    }
  }
}
