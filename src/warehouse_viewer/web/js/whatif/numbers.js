// SPDX-License-Identifier: Apache-2.0
// What is wrong with the numbers of a form, in the words of its labels.

import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';

/** What a field of numbers takes. */
export function expectedOf({ min, max, step }) {
  const least = number(min, 0, 2), most = number(max, 0, 2);
  const isWhole = step !== 'any' && !String(step).includes('.');
  if (!max) return isWhole ? tr`a whole number from ${least} on is expected` : tr`a number from ${least} on is expected`;
  return isWhole ? tr`a whole number from ${least} to ${most} is expected` : tr`a number from ${least} to ${most} is expected`;
}

const labelOf = (field) => field.labels[0].firstChild.textContent.trim();

/** A sentence about the first number that is wrong, and '' where none is; those that are wrong are
 *  marked. A field that is not shown is not asked. */
export function faultOf(form) {
  const fields = [...form.querySelectorAll('input[type="number"]')].filter((field) => !field.closest('[hidden]'));
  const wrong = fields.filter((field) => !field.validity.valid);
  for (const field of fields) field.removeAttribute('aria-invalid');
  for (const field of wrong) field.setAttribute('aria-invalid', 'true');
  return wrong.length ? `${labelOf(wrong[0])}: ${expectedOf(wrong[0])}.` : '';
}

/** Puts the focus into the first number that is wrong. */
export function goToFault(form) {
  form.querySelector('[aria-invalid]')?.focus();
}
