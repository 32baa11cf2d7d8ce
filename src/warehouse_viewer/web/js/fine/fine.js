// SPDX-License-Identifier: Apache-2.0
// The fine picture, which a graphics card draws: shadows of a light, materials that reflect a hall, concrete,
// walls and fog, rings and lamps of robots, racks with beams, bevels, numbers of storage units near by. The plain picture stays
// beneath, and comes back when this is off.

import * as THREE from '/three/build/three.module.js';
import { Ground } from './ground.js';
import { Marks } from './marks.js';
import { dress, undress } from './metal.js';
import { Numbers } from './numbers.js';
import { Shapes } from './shapes.js';
import { Sunlight } from './sunlight.js';

/** Light of day and of night: sky, sun, and how dark shadows are. */
const LIGHT = {
  light: { sky: 0.62, sun: 0.5, tint: 0xfff1dc, shade: 0.3 },
  dark: { sky: 0.4, sun: 0.3, tint: 0xbfd0ff, shade: 0.45 },
};
const PLAIN = { sky: 0.62, sun: 0.36, tint: 0xffffff };

export class Fine {
  /** `page` has the stage, the actors and the world. */
  constructor({ stage, actors, world }) {
    Object.assign(this, { stage, actors, world, isOn: false });
    this.sunlight = new Sunlight(stage);
    this.ground = new Ground(stage);
    this.marks = new Marks(actors.robots, world);
    this.shapes = new Shapes(actors);
    this.numbers = new Numbers(stage, world, actors);
  }

  set(isOn) {
    if (isOn === this.isOn) return;
    this.isOn = isOn;
    this.sunlight.set(isOn);
    this.ground.set(isOn);
    this.numbers.set(isOn);
    if (isOn) this.dress();
    else this.undress();
    this.setTheme(document.documentElement.dataset.theme);
  }

  /** All robots, storage units and scenery are others now. */
  renew() {
    if (!this.isOn) return;
    this.marks = new Marks(this.actors.robots, this.world);
    this.shapes = new Shapes(this.actors);
    this.dress();
    this.ground.renew();
    this.numbers.renew();
  }

  dress() {
    this.shapes.add();
    for (const crowd of this.actors.crowds) dress(crowd, this.stage.renderer);
    this.marks.add();
  }

  undress() {
    this.marks.remove();
    for (const crowd of this.actors.crowds) undress(crowd);
    this.shapes.remove();
  }

  setTheme(theme) {
    const light = this.isOn ? LIGHT[theme] : PLAIN, { sky, sun } = this.stage;
    sky.intensity = light.sky;
    sun.intensity = light.sun;
    sun.color.set(new THREE.Color(light.tint));
    this.sunlight.setShade(light.shade);
    this.ground.setTheme(theme);
    this.marks.setNight(theme === 'dark');
    this.stage.renew();
  }

  /** Before each picture, for a View. */
  draw(view) {
    if (!this.isOn) return;
    this.sunlight.follow();
    this.ground.follow();
    this.numbers.draw(view);
  }
}
