// SPDX-License-Identifier: Apache-2.0
// Where the addresses of this warehouse begin: at '', or at /s/NAME or /recordings/NAME
// where a hub serves it.

export const ROOT = /^\/(?:s|recordings)\/[^/]+/.exec(location.pathname)?.[0] ?? '';

/** The address of a path of this warehouse's server, for a link or a request. */
export const at = (path) => ROOT + path;

/** The page's path as its server has it. */
export const ownPath = () => location.pathname.slice(ROOT.length);
