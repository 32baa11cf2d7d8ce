// SPDX-License-Identifier: Apache-2.0
// Changes that a forecast tries, as a person writes them.

/** The changes that lines say; a line without a time happens at once. */
export function changesOf(text) {
  return text.split('\n').map((line) => line.trim()).filter(Boolean).map((line) => (/^[+\d]/.test(line) ? line : `+0 ${line}`));
}

/** A refusal without the '+0', 'at once', that no person wrote. */
export const refusalOf = (text, written) => (/^\+0 /m.test(written) ? text : text.replace(/^'\+0 /, "'"));
