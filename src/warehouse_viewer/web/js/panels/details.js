// SPDX-License-Identifier: Apache-2.0
// The panel of the selection: its facts, and the commands for it.

import { command, post } from '../base/api.js';
import { $, enable, make, on, press, setText } from '../base/dom.js';
import { LiftStatus, RobotMode, Turn } from '../base/message_enums.js';
import { number, percent } from '../language/numbers.js';
import { tr } from '../language/texts.js';
import { ACTIVITY, ACTIVITY_CLASS, FAILURE, MODE_WORDS, shownName, STATE } from '../base/words.js';

const LIFT = { drop: LiftStatus.DROP, carry: LiftStatus.CARRY };
const COMMANDS = ['left', 'right', 'carry', 'drop', 'remove'];
const LATE = ['pending', 'accepted']; // outcomes of a command that has not ended
const MODE = {
  [RobotMode.AUTOMATIC]: tr`the coordinator commands it`,
  [RobotMode.MANUAL]: tr`you command it; other robots drive around it`,
  [RobotMode.OUT_OF_SERVICE]: tr`the coordinator leaves it alone; other robots drive around it`,
};
const WAITS = tr`sent; the simulation is paused: the robot starts when it resumes, even after a reset`;

export class Details {
  /** `select(name)` for links to others; `say(text, kind, at)` for what became of a command;
   *  `isPaused()`: whether time stands still; `fleet` is the FleetPanel, `fallen` the
   *  FallenItems, `wayOf(id)` what the coordinator plans for a robot, `stationOf(name)`
   *  what the shift says of a station, `moment()` and `log` what the Care takes, `wall()` that moment on
   *  the wall [s since 1970], undefined: no vehicles are recorded. */
  constructor(world, select, say, { isPaused, fleet, fallen, wayOf, stationOf, moment, wall, log }) {
    Object.assign(this, { world, select, say, isPaused, fleet, fallen, wayOf, stationOf, name: null, robot: null });
    this.about = { moment, wall, log };
    for (const button of $('modes').children) {
      on(button, 'click', () => this.setMode(button.dataset.mode));
    }
    on($('left'), 'click', () => this.turn(Turn.COUNTERCLOCKWISE));
    on($('right'), 'click', () => this.turn(Turn.CLOCKWISE));
    on($('carry'), 'click', () => this.lift('carry'));
    on($('drop'), 'click', () => this.lift('drop'));
    on($('fetch'), 'click', () => this.sendRobotHere());
    on($('close'), 'click', () => select(null));
  }

  get thing() {
    return this.name && this.world.indexOf.get(this.name);
  }

  /** Index of the selected robot, or -1. */
  get selectedRobot() {
    return this.thing?.kind === 'robot' ? this.thing.index : -1;
  }

  show(name) {
    this.name = name;
    if (this.selectedRobot >= 0) this.robot = name; // the last one, to be sent elsewhere
    $('details-panel').hidden = !name;
    $('answer').hidden = true;
    this.shownFacts = null;
    this.refresh();
    if (name) this.careFor();
  }

  /** What the server says of it comes once something is selected. */
  async careFor() {
    const { Care } = await this.load();
    this.care ??= new Care(this, this.about);
    this.care.show();
    this.care.take(this.why);
    this.refresh();
  }

  /** Loads what a selection needs. */
  async load() {
    this.parts ??= await import('./care.js');
    return this.parts;
  }

  /** Takes why the selected robot or station waits; null: the server knows no reason. */
  takeWhy(why) {
    this.why = why;
    this.care?.take(why);
  }

  refresh() {
    const { thing } = this;
    if (!this.name) return;
    setText($('name'), shownName(this.name));
    const isRobot = thing?.kind === 'robot';
    $('orders').hidden = !isRobot;
    for (const id of ['scan', 'path', 'remove']) $(id).hidden = !isRobot;
    $('badge').hidden = $('mode').hidden = !isRobot;
    $('modes').hidden = !isRobot || !this.fleet.runs;
    if (isRobot) this.refreshRobot(thing.index);
    $('fetch').hidden = thing?.kind !== 'unit' || !this.world.indexOf.has(this.robot);
    setText($('fetch'), tr`Send ${this.robot} beneath it`);
    $('pick-up').hidden = thing?.kind !== 'item' || this.fallen.unitOf(thing.index) < 0;
    this.facts(thing ? this.factsOf(thing) : [['', tr`no longer exists`]]);
    this.care?.refresh();
  }

  refreshRobot(i) {
    const does = this.world.activity[i];
    $('badge').className = `badge ${ACTIVITY_CLASS[does]}`;
    $('badge').textContent = ACTIVITY[does];
    const load = this.world.shelf[i], over = this.world.unitOver(i);
    enable($('carry'), load ? tr`it carries a storage unit` : over < 0 ? tr`no storage unit stands over it` : '');
    enable($('drop'), load ? '' : tr`it carries no storage unit`);
    enable($('remove'), load ? tr`it carries a storage unit` : '');
    const mode = this.fleet.modeOf(this.world.scene.robots[i]);
    for (const button of $('modes').children) press(button, button.dataset.mode === mode);
    $('mode').hidden = !mode;
    setText($('mode'), mode ? MODE_WORDS[mode] : '');
    this.showWhy();
  }

  /** Says below the buttons why some can't be pressed: a finger reads no title. */
  showWhy() {
    const buttons = COMMANDS.map($).filter((button) => button.disabled);
    setText($('why'), whyNot(buttons.map((button) => [button.textContent.trim(), button.dataset.why])));
    $('why').hidden = !buttons.length;
  }

  factsOf(thing) {
    const [x, y, z, yaw] = this.world.placeOf(thing);
    const { index } = thing;
    if (thing.kind === 'station') return this.factsOfStation();
    const out = [[tr`position`, `${metres(x)}, ${metres(y)} m`]];
    if (Math.abs(z) > 0.005) out.push([tr`height`, `${metres(z)} m`]);
    out.push([tr`heading`, `${number(Math.round(yaw * 180 / Math.PI) + 0)}°`]);
    return out.concat({ robot: () => this.factsOfRobot(index), unit: () => this.factsOfUnit(index),
      item: () => this.factsOfItem(index) }[thing.kind]?.() ?? []);
  }

  factsOfRobot(index) {
    const { world } = this, { scene } = world;
    const out = [[tr`motion`, STATE[world.state[index]]], ...this.planOf(scene.robots[index])];
    const broken = FAILURE.filter((_, bit) => world.failures[index] >> bit & 1);
    if (broken.length) out.push([tr`broken`, broken.join(', ')]);
    if (world.charge.some((c) => c < 100)) out.push([tr`battery`, percent(world.charge[index] / 100)]);
    const load = world.loadOf(index), limit = world.loadLimit[index];
    out.push([tr`load`, load < 0 ? tr`none` : link(scene.units[load])]);
    if (limit > 0) out.push([tr`deceleration`, tr`${number(limit, 1)} m/s² at most, so that the load does not tip`]);
    if (load >= 0) out.push([tr`items`, String(world.itemsOf[load].length)]);
    return [...out, ...this.factsOfVehicle(scene.robots[index])];
  }

  /** Order, base and errors of a robot at a broker by VDA 5050. */
  factsOfVehicle(id) {
    const past = this.about.moment() === null ? null : this.about.wall();
    return this.parts?.vda5050Of(id, { past, changed: () => this.refresh() }) ?? [];
  }

  /** Where a robot at a broker says that it will drive; null: it does not, or that is not known. */
  plannedOf(id) {
    return id && this.about.moment() === null ? this.parts?.plannedOf(id) ?? null : null;
  }

  factsOfUnit(index) {
    const carrier = this.world.carrier[index];
    const items = this.world.itemsOf[index].map((i) => this.world.scene.items[i]);
    return [[tr`carried by`, carrier ? link(`kiva${carrier}`) : tr`no robot`], [tr`items`, items.map(shownName).join(', ') || tr`none`]];
  }

  factsOfItem(index) {
    const { scene } = this.world, unit = scene.item_unit[index], home = this.fallen.unitOf(index);
    if (home >= 0) return [[tr`fell off`, link(scene.units[home])]];
    return [[tr`lies on`, unit < 0 ? tr`no storage unit` : link(scene.units[unit])]];
  }

  /** What a station does, waits for and has in its queue. */
  factsOfStation() {
    return this.parts?.factsOfStation(this.stationOf(this.name), this.world.stamp, link) ?? [];
  }

  /** Where the coordinator sends a robot, and for whom it waits. */
  planOf(id) {
    const way = this.wayOf(id), out = [];
    if (way?.goal) {
      const [x, y] = way.goal;
      const station = this.world.scene.stations.find((s) => Math.hypot(s.x - x, s.y - y) < 0.1);
      out.push([tr`goes to`, station ? link(station.name) : `${metres(x)}, ${metres(y)} m`]);
    }
    if (way?.waitsFor && !this.care?.why) out.push([tr`waits for`, link(`kiva${way.waitsFor}`)]);
    return out;
  }

  facts(facts) {
    const text = JSON.stringify(facts);
    if (text === this.shownFacts) return;
    this.shownFacts = text;
    $('facts').replaceChildren(...facts.flatMap(([what, value]) => [
      make('dt', { textContent: what }), make('dd', {}, ...[value].flat().map((part) => this.shown(part)))]));
  }

  /** A value as it is shown: a text, or a link to a thing. */
  shown(value) {
    if (typeof value !== 'object') return value;
    return make('button', { textContent: shownName(value.link), className: value.isInText ? 'link-text' : '', click: () => this.select(value.link) });
  }

  // --- commands; `at` is where in the window the answer belongs
  go(x, y, at) {
    return this.order(this.name, 'mov', { x, y }, at);
  }

  turn(direction) {
    return this.order(this.name, 'rot', { direction });
  }

  lift(what) {
    const i = this.selectedRobot;
    if (i < 0 || $(what).disabled) return null;
    const over = this.world.unitOver(i);
    const shelf = what === 'drop' ? this.world.shelf[i] : numberOf(this.world.scene.units[over]);
    return this.order(this.name, 'lift', { status: LIFT[what], shelf_id: shelf });
  }

  /** Sets whether the coordinator commands the selected robot, a person does, or it is out of service. */
  setMode(mode) {
    const id = numberOf(this.name);
    return this.attempt(async () => {
      const { knownPerson } = await this.load();
      return post(`/robots/${id}/mode`, { mode, by: knownPerson() });
    }, MODE[mode]);
  }

  /** Does what a button says, and shows what became of it. */
  async attempt(request, done = '') {
    const { name } = this;
    const answer = (text, kind) => {
      if (this.name !== name) return;
      Object.assign($('answer'), { hidden: false, textContent: text });
      $('answer').dataset.kind = kind;
    };
    try {
      const { message } = await request();
      answer(done || message || tr`done`, 'done');
    } catch (error) {
      answer(`${error.refused ? tr`refused: ` : ''}${error.message}`, 'refused');
    }
  }

  sendRobotHere() {
    const [x, y] = this.world.placeOf(this.thing);
    return this.order(this.robot, 'mov', { x: Math.round(x), y: Math.round(y) });
  }

  async order(robot, name, fields, at) {
    const answer = (text, kind) => {
      if (kind === 'refused' || kind === 'blocked') this.say(`${robot}: ${text}`, kind, at);
      if (![this.name, this.robot].includes(robot)) return;
      Object.assign($('answer'), { hidden: false, textContent: text });
      $('answer').dataset.kind = kind;
    };
    answer(this.isPaused() ? WAITS : tr`sent`, 'sent');
    try {
      const { outcome, events } = await command(numberOf(robot), name, fields);
      const text = LATE.includes(outcome) ? tr`not yet done` : outcome;
      const said = events.at(-1)?.text ?? '';
      answer(!said || said.startsWith(text) ? said || text : `${text}: ${said}`, outcome);
    } catch (error) {
      answer(error.refused ? tr`refused: ${error.message}` : error.message, 'refused');
    }
  }
}

/** Why buttons can't be pressed, of [label, reason] each: 'Carry: …. Drop, Remove: …'. */
export function whyNot(buttons) {
  const labels = new Map();
  for (const [label, why] of buttons) labels.set(why, [...labels.get(why) ?? [], label]);
  return [...labels].map(([why, all]) => `${all.join(', ')}: ${why}.`).join(' ');
}

const metres = (length) => number(Math.round(100 * length) / 100 + 0, 2); // + 0: never -0.00
const link = (name) => ({ link: name });
const numberOf = (name) => Number(name.match(/\d+$/)[0]);
