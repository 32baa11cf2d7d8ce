// SPDX-License-Identifier: Apache-2.0
// While a page shows what is past nothing can be commanded, and each button says why.

import { forbid } from '../base/api.js';
import { $, enable, withhold } from '../base/dom.js';

const COMMANDS = ['left', 'right', 'add', 'add-person', 'build', 'fetch', 'pick-up'];
const MODES = '#modes button';

/** Withholds all commands for a reason; '': gives them back. */
export function freeze(reason) {
  forbid(reason);
  withhold(reason);
  const buttons = [...COMMANDS.map($).filter(Boolean), ...document.querySelectorAll(MODES)];
  for (const button of buttons) enable(button, '');
}
