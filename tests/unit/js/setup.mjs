// SPDX-License-Identifier: Apache-2.0
// Lets node load the page's modules as a browser does: /three/… is Debian's libjs-three, and a page
// has an address.

import { register } from 'node:module';

globalThis.location ??= new URL('http://here/');
register('./loader.mjs', import.meta.url);
