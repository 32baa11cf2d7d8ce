// SPDX-License-Identifier: Apache-2.0
// Numbers as the person before the browser writes them.

/** A number with that many digits behind the point, or up to `most` where there are such. */
export function number(value, digits = 0, most = digits) {
  const text = Number(value).toLocaleString(undefined, { minimumFractionDigits: digits, maximumFractionDigits: most });
  return text.replace('-', '−');
}

/** A share of 1, as '12 %'. */
export const percent = (share, digits = 0) => `${number(100 * share, digits)} %`;
