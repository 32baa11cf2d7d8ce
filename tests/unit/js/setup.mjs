// SPDX-License-Identifier: Apache-2.0
// Lets node load the page's modules as a browser does: /three/… is Debian's libjs-three.

import { register } from 'node:module';

register('./loader.mjs', import.meta.url);
