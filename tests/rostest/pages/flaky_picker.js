// SPDX-License-Identifier: Apache-2.0
// A picker with a scanner, and a network that loses a third of the reports and a third of the answers;
// run in a station's screen. window.picker tells how far it is.

const gone = () => Promise.reject(new TypeError('the network is gone'));

function scan(code) {
  for (const key of [...code, 'Enter']) {
    document.body.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
  }
}

{
  const { page } = window;
  const LOST = 1 / 3, KEYS = 4; // of requests, of answers; between two scans [ms]
  const picker = { lostRequests: 0, lostAnswers: 0, done: 0, refused: [], isOffline: false };
  const { fetch: reach } = window;
  let seed = 7;
  const chance = () => { // of Park and Miller (1988): the same in each run
    seed = (seed * 48271) % 2147483647;
    return seed / 2147483647;
  };
  window.fetch = async (address, options) => {
    if (picker.isOffline) return gone();
    if (!String(address).includes('/picks/')) return reach(address, options);
    if (chance() < LOST) {
      picker.lostRequests += 1;
      return gone();
    }
    const answer = await reach(address, options);
    if (chance() >= LOST) return answer;
    picker.lostAnswers += 1;
    return gone();
  };
  page.outbox.sleep = (ms, wake) => setTimeout(wake, ms / 20);
  const { refused } = page.outbox.handlers;
  page.outbox.handlers.refused = (entry, reason) => {
    picker.refused.push(reason);
    refused(entry, reason);
  };
  const { add } = page.outbox;
  page.outbox.add = (entry) => {
    picker.done += entry.body.quantity;
    add.call(page.outbox, entry);
  };
  picker.timer = setInterval(() => {
    const { task } = page.bench;
    if (!task) return;
    for (let i = 0; i < task.quantity; i += 1) scan(task.sku);
    scan(`T0${task.tote}`);
  }, KEYS);
  window.picker = picker;
}
