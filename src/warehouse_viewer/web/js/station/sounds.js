// SPDX-License-Identifier: Apache-2.0
// Short sounds, made by the browser; it is silent until a person has touched the page.

// Notes of each: [frequency [Hz], begin, length [s]].
const TUNES = {
  counted: [[1320, 0, 0.05]],
  done: [[880, 0, 0.08], [1320, 0.08, 0.1]],
  complete: [[880, 0, 0.1], [1109, 0.1, 0.1], [1319, 0.2, 0.2]],
  arrives: [[523, 0, 0.15], [784, 0.18, 0.25]],
  refused: [[196, 0, 0.18], [156, 0.2, 0.3]],
};
const LOUD = 0.25;

export class Sounds {
  /** shelf: keeps whether they are muted. */
  constructor(shelf) {
    Object.assign(this, { shelf, isMuted: shelf.read('muted') === true, context: null, played: 0 });
    for (const type of ['pointerdown', 'keydown']) addEventListener(type, () => this.wake(), { capture: true });
  }

  wake() {
    this.context ??= new AudioContext();
    if (this.context.state === 'suspended') this.context.resume().catch(() => {});
  }

  mute(isMuted) {
    this.isMuted = isMuted;
    this.shelf.write('muted', isMuted);
    if (!isMuted) this.play('done');
  }

  play(name) {
    if (this.isMuted || this.context?.state !== 'running') return;
    this.played += 1;
    for (const note of TUNES[name]) this.note(name === 'refused' ? 'square' : 'sine', ...note);
  }

  note(type, frequency, begin, length) {
    const { context } = this, at = context.currentTime + begin;
    const tone = new OscillatorNode(context, { type, frequency });
    const gain = new GainNode(context, { gain: LOUD });
    gain.gain.setValueAtTime(LOUD, at + length - 0.02);
    gain.gain.linearRampToValueAtTime(0, at + length); // without it, it cracks
    tone.connect(gain).connect(context.destination);
    tone.start(at);
    tone.stop(at + length);
  }
}
