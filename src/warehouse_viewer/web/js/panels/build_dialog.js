// SPDX-License-Identifier: Apache-2.0
// The dialog that builds a warehouse: a size, or counts of one's own.

import { get, post } from '../base/api.js';
import { $, on } from '../base/dom.js';
import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';

const COUNTS = ['robots', 'shelves', 'items'];

export class BuildDialog {
  /** `present()` and `say` as the Builder has them. */
  constructor(present, say) {
    Object.assign(this, { present, say, sizes: { presets: {}, limits: {} } });
    on($('size'), 'change', () => this.showCounts());
    on($('plan'), 'submit', (event) => event.submitter.value && this.build(event));
    for (const what of COUNTS) {
      // Other numbers than a size's are one's own.
      on($(`own-${what}`), 'input', () => {
        $('size').value = '';
        this.showCounts();
      });
    }
  }

  async open() {
    this.answer('');
    const { isWorking, ...counts } = this.present();
    $('plan-loss').hidden = !isWorking;
    $('plan-loss').textContent = tr`${counts.robots} robots are at work here. Their transports are lost, and a shift ends: its stock lies on storage units that go.`;
    try {
      this.sizes = await get('/warehouse/sizes');
    } catch (error) {
      this.answer(error.message);
    }
    this.offer(counts);
    for (const what of COUNTS) {
      const field = $(`own-${what}`), limit = this.sizes.limits[what];
      if (!limit) continue;
      field.max = limit;
      field.parentElement.querySelector('span').textContent = tr`at most ${number(limit)}`;
    }
    this.showCounts();
    $('builder').showModal(); // not before: what a quick hand chose meanwhile would be overwritten
  }

  /** Begins with the size of what stands here. */
  offer(counts) {
    const same = Object.entries(this.sizes.presets).find(([, preset]) => COUNTS.every((what) => preset[what] === counts[what]));
    $('size').value = same?.[0] ?? '';
    for (const what of COUNTS) $(`own-${what}`).value = counts[what];
  }

  /** A size has counts of its own; with others it is one that has a name of its own. */
  showCounts() {
    const preset = this.sizes.presets[$('size').value];
    for (const what of COUNTS) if (preset) $(`own-${what}`).value = preset[what];
    $('own-name-label').hidden = $('own-name').disabled = $('size').value !== '';
  }

  /** Builds the warehouse; if the server refuses, the dialog stays open and shows why. */
  async build(event) {
    event.preventDefault();
    this.answer(tr`building …`, 'sent');
    const [, yes] = $('plan').querySelectorAll('.answers button');
    yes.disabled = true;
    try {
      const { message } = await post('/warehouse', planOf($('size').value, {
        name: $('own-name').value,
        ...Object.fromEntries(COUNTS.map((what) => [what, $(`own-${what}`).valueAsNumber])),
      }));
      $('builder').close();
      this.say(message || tr`built`, 'done');
    } catch (error) {
      this.answer(error.message);
    }
    yes.disabled = false;
  }

  answer(text, kind = 'refused') {
    Object.assign($('plan-answer'), { hidden: !text, textContent: text });
    $('plan-answer').dataset.kind = kind;
  }
}

/** The body of a request for a warehouse: a preset by its name, or counts of one's own. */
export function planOf(size, { name, robots, shelves, items }) {
  return size ? { name: size } : { name, robots, shelves, items };
}
