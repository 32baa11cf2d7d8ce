// SPDX-License-Identifier: Apache-2.0
// A scanner that types: fast keys that end with Enter, or all keys from a prefix on to Enter.

const GAP = 60; // between two keys of a scanner, at most [ms]; a person takes longer
const SHORTEST = 2; // characters of a code
const LONGEST = 200;
const LOST = 3000; // a code with a prefix is dropped if no Enter follows within this [ms]

export class Scanner {
  /** take(code) is called for each; prefix: one key, such as '~' or 'F8', or '' for none. */
  constructor(take, prefix = '') {
    Object.assign(this, { take, prefix, text: null, before: -Infinity });
  }

  /** Handles a key at a time [ms]. Returns whether it belongs to a code, so that it must do nothing
   *  else: its Enter would press the button that has the focus. */
  key(key, now) {
    if (this.prefix && key === this.prefix) return this.begin(now);
    this.giveUp(now - this.before);
    this.before = now;
    if (this.text === null) return false;
    if (key === 'Enter') return this.end();
    if (key.length !== 1) return false;
    if (this.text.length < LONGEST) this.text += key;
    return Boolean(this.prefix) || this.text.length > 1; // a space presses buttons, too
  }

  /** Forgets a code that goes on too late [ms], and begins another one where that takes no prefix. */
  giveUp(gap) {
    if (this.prefix) this.text = gap > LOST ? null : this.text;
    else if (gap > GAP || this.text === null) this.text = '';
  }

  begin(now) {
    Object.assign(this, { text: '', before: now });
    return true;
  }

  end() {
    const code = this.text.trim();
    this.text = null;
    if (code.length < SHORTEST) return false;
    this.take(code);
    return true;
  }

  /** Hears the keys of a page; what is typed into a field stays there. */
  listen(target) {
    target.addEventListener('keydown', (event) => {
      const { key, ctrlKey, altKey, metaKey, timeStamp } = event;
      if (ctrlKey || altKey || metaKey || event.target.closest?.('input, textarea, select')) return;
      if (!this.key(key, timeStamp)) return;
      event.preventDefault();
      event.stopPropagation();
    }, { capture: true });
  }
}
