// SPDX-License-Identifier: Apache-2.0
// Keeps the screen of a tablet on, where the browser can; a hidden page loses that, and asks again.

export function stayAwake() {
  document.addEventListener('visibilitychange', ask);
  ask();
}

function ask() {
  if (!document.hidden) navigator.wakeLock?.request('screen').catch(() => {}); // such as on a low battery
}
