// SPDX-License-Identifier: Apache-2.0
// The page: what comes from the server goes to the World and from there into picture and panels.

import { tr } from './language/texts.js';
import { Actors } from './scene/actors.js';
import { Bar } from './panels/bar.js';
import { Builder } from './panels/builder.js';
import { Connection } from './base/connection.js';
import { Details } from './panels/details.js';
import { $, isPressed, on, onTheme, press, setText } from './base/dom.js';
import { Drawers, marginsOf } from './base/drawers.js';
import { FallenItems } from './panels/fallen.js';
import { FleetPanel } from './panels/fleet.js';
import { Keys } from './panels/keys.js';
import { Labels } from './scene/labels.js';
import { RobotList } from './panels/list.js';
import { EventLog } from './panels/log.js';
import { Navigator } from './scene/navigator.js';
import { Overlays } from './scene/overlays.js';
import { isPerson, People } from './panels/people.js';
import { Picker } from './scene/picker.js';
import { Pointer } from './scene/pointer.js';
import { VERSION } from './base/protocol.js';
import { lookOf, momentOf } from './replay/link.js';
import { Timeline } from './replay/timeline.js';
import { Requested } from './panels/requested.js';
import { SceneKeys, speak } from './scene/scene_keys.js';
import { Signs } from './scene/signs.js';
import { Stage } from './scene/stage.js';
import { drawsInSoftware } from './base/software.js';
import { Tip } from './base/tip.js';
import { Vehicles } from './panels/vehicles.js';
import { shownName } from './base/words.js';
import { World } from './base/world.js';

const PANELS_EVERY = 250; // [ms]
const NOTABLE = 60; // between two pictures; a person sees it [ms]
const STATION = 0.5; // half side of the mark around a station [m]
const ROOM = 40; // around what is selected, beside its panel [px]
const GROWS = 2000; // for which the panel of what was selected may grow [ms]
const TYPING = 300; // after a key, what is typed may be whole [ms]

class Page {
  constructor() {
    this.world = new World();
    this.tip = new Tip();
    const select = (name) => this.select(name);
    const say = (text, kind, at) => this.tip.say(text, kind, at);
    this.bar = new Bar(say, (...offer) => this.tip.offer(...offer));
    this.list = new RobotList(this.world, select, (name) => this.find(name), (text) => this.lookFor(text),
      (id) => this.fleet?.modeOf(id));
    this.log = new EventLog(select);
    this.ways = new Map(); // of robots, by id, as the coordinator plans them
    this.fleet = new FleetPanel(select);
    this.builder = new Builder(say, () => this.present());
    this.people = new People(say);
    this.vehicles = new Vehicles(this);
    this.placers = [this.builder, this.people, this.vehicles];
    this.fallen = new FallenItems(this.world, () => this.selected,
      (request) => this.builder.attempt(request));
    this.requested = new Requested(this.world);
    this.details = new Details(this.world, select, say, { isPaused: () => this.bar.paused,
      fleet: this.fleet, fallen: this.fallen, wayOf: (id) => this.ways.get(id),
      stationOf: (name) => this.signs?.stations.get(name), moment: () => this.moment, wall: () => this.timeline.wall, log: this.log });
    this.drawers = new Drawers(() => this.fitPanels());
    new ResizeObserver(() => this.uncover()).observe($('details-panel'));
    this.selected = null;
    this.isNews = false; // that the panels don't show yet
    this.floor = '';
    this.paths = {};
    this.scans = new Map();
    this.openStage();
    this.addButtons();
    for (const placer of this.placers) placer.changed = () => this.lightCells();
    this.keys = new Keys((step) => this.next(step), () => this.leave(), () => this.goToSearch());
    setInterval(() => this.isNews && this.soon(() => this.refreshPanels()), PANELS_EVERY);
    this.connection = new Connection({
      state: (live, reason) => this.bar.showLink(live, reason),
      scene: (scene) => this.takeScene(scene),
      update: (update) => this.takeUpdate(update),
      status: (status) => this.takeStatus(status),
      events: ({ events }) => this.takeEvents(events),
      paths: ({ paths }) => this.takePaths(paths),
      scan: (scan) => this.takeScan(scan),
      fleet: ({ fleet }) => this.takeFleet(fleet),
      ways: ({ ways }) => this.takeWays(ways),
      zones: ({ zones }) => this.takeZones(zones),
      requested: ({ units }) => this.requested.take(units),
      why: ({ why }) => this.moment === null && this.details.takeWhy(why),
    }, (act) => this.soon(act));
    this.timeline = new Timeline(this);
    this.askHash();
  }

  /** /#kiva3 shows that, /#sku-17 where it is, and /#see=kiva7&from=… is a look of now; /#t=630 is a moment,
   *  which the time line shows. */
  askHash() {
    this.asks = location.hash.length > 1 && !momentOf(location.hash);
    this.answerHash();
  }

  /** Shows what the address asks for, once it is known what stands there. */
  answerHash() {
    if (!this.asks || !('protocol' in this.world.scene)) return;
    this.asks = false;
    const look = lookOf(location.hash), name = nameIn(location.hash);
    if (look.name || look.view) this.look(look);
    else if (this.world.indexOf.has(name)) this.find(name);
    else this.list.ask(location.hash.slice(1));
  }

  /** Leaves the picture out where there is no WebGL; list and commands work all the same. */
  openStage() {
    try {
      this.stage = new Stage($('stage'), (now) => this.beforeDraw(now),
        (gap) => this.showPace(gap));
    } catch (error) {
      this.tip.say(tr`no picture: this browser offers no WebGL (${error.message})`, 'refused');
      return;
    }
    this.actors = new Actors(this.stage, this.world);
    this.labels = new Labels(this.stage, this.world, $('labels'));
    this.overlays = new Overlays(this.stage, this.world);
    this.signs = new Signs(this.stage, this.world, (alarms) => this.fleet.takeAlarms(alarms));
    this.picker = new Picker(this.stage, this.actors);
    this.navigator = new Navigator(this.stage);
    this.pointer = new Pointer(this, this.picker, this.overlays);
    this.sceneKeys = new SceneKeys(this);
    on(window, 'resize', () => this.drawers.fit());
    this.fitPanels();
  }

  /** Does something when the next picture is drawn: panels that change with it cost little more. */
  soon(act) {
    if (this.stage) this.stage.soon(act);
    else act();
  }

  /** Asks the server for no more updates than the page can draw. */
  showPace(gap) {
    this.connection.slowTo(gap / 1000);
    $('pace').hidden = gap < NOTABLE;
    setText($('pace'), tr`${Math.round(1000 / gap)} frames/s: rendered without a graphics card`);
  }

  /** Keeps what is looked at in the middle of what the panels leave free. */
  fitPanels() {
    this.stage?.setMargins(marginsOf());
    this.list.draw();
  }

  // --- from the server
  takeScene(scene) {
    if (scene.protocol !== VERSION) location.reload();
    this.world.setScene(scene);
    this.scans.clear();
    this.buildPicture(scene);
    this.select(this.world.indexOf.has(this.selected) ? this.selected : null);
    this.list.search($('search').value);
    this.answerHash();
  }

  buildPicture(scene) {
    const { floor, grid } = scene;
    if (!this.stage) return;
    this.stage.pace.expect(scene.robots.length);
    this.actors.build();
    this.stage.setPaint(scene);
    this.signs.build(document.documentElement.dataset.theme);
    this.trails?.clear();
    if (String(floor) !== this.floor) {
      this.floor = String(floor);
      this.stage.setFloor(floor, grid);
      this.navigator.showAll();
    }
    this.fine?.renew();
  }

  takeUpdate(update) {
    if (update.revision !== this.world.scene.revision) return; // of a scene that is past
    const changed = this.world.apply(update, performance.now());
    this.isNews = true;
    this.timeline.note(update.stamp);
    if (!this.stage) return;
    this.actors.robots.paint(changed.robots);
    this.actors.placeUnits(changed.units);
    this.actors.placeLoose(changed.loose);
    this.actors.placeScenery(changed.scenery);
    this.trails?.note(changed.robots);
    this.stage.invalidate();
  }

  takeStatus(status) {
    this.bar.showStatus(status);
    this.showStart(status);
    if (!status.away) this.stage?.pace.yieldTo(status.paused ? 1 : status.factor, status.paused ? 1 : status.target_factor);
  }

  /** The invitation; a server that can neither start a shift nor break a robot shows a picture alone. */
  async showStart(status) {
    const { start_shift: noShift, fail } = status.lacks ?? {};
    if (noShift && fail) return;
    const { Start } = await import('./panels/start.js');
    this.start ??= new Start(this);
    this.start.takeStatus(status);
  }

  takeEvents(events) {
    this.log.add(events);
    if (events.some((e) => [e.model, e.other].includes(this.selected))) {
      this.log.drawOwn(this.selected);
    }
  }

  takePaths(paths) {
    this.paths = paths;
    this.showExtras();
  }

  /** `past`: the stations as they were, where that is not now. */
  takeFleet(fleet, past = null) {
    const came = Boolean(fleet) !== this.fleet.runs;
    this.isNews = true;
    this.fleet.take(fleet);
    this.signs?.take(fleet, past);
    if (!came) return;
    this.start?.refresh();
    if (!fleet) this.takeWays(new Map());
    this.list.search($('search').value);
    this.watch();
    this.fitPanels();
  }

  takeWays(ways) {
    this.ways = ways;
    this.showWays();
    this.showExtras();
  }

  /** What is closed; the layer that draws it is loaded with the first zone. */
  async takeZones(zones) {
    this.closed = zones;
    this.zoneTool?.take(zones);
    if (!this.stage || (!this.zones && !zones.length)) return;
    await this.loadZones();
    this.zones.take(this.closed);
  }

  async loadZones() {
    if (!this.stage) return;
    const { ZoneLayer } = await import('./layers/zones.js');
    this.zones ??= new ZoneLayer(this.stage, this.world);
  }

  async drawZone(isOn) {
    const [{ ZoneTool }] = await Promise.all([import('./panels/zone_tool.js'), this.loadZones()]);
    this.zoneTool ??= new ZoneTool(this);
    this.zoneTool.take(this.closed ?? []);
    this.zoneTool.want(isOn);
  }

  takeScan(scan) {
    this.scans.set(scan.id, scan);
    this.showExtras();
  }

  // --- the picture
  beforeDraw(now) {
    const moved = this.world.advance(now + this.stage.pace.gap);
    this.actors.placeRobots(moved);
    const flies = this.navigator.advance(now);
    if (moved.length) {
      this.actors.belts.run(Math.min(0.1, (now - (this.drawn ?? now)) / 1000));
      this.showExtras();
      this.routes?.follow();
    }
    this.drawn = now;
    const isUnsettled = this.actors.fill(this.stage.camera, innerHeight, now);
    this.drawExtras();
    this.labels.draw(this.actors.view, this.named(), [
      ...this.signs.labels(this.actors.view), ...this.where?.draw() ?? [], ...this.zones?.labels() ?? [], ...this.fallen.labels(),
      ...this.requested.labels()]);
    return flies || isUnsettled || this.world.moving.size > 0;
  }

  /** What lies around and over the floor, before each picture. */
  drawExtras() {
    this.zones?.hide(this.moment !== null);
    this.fine?.draw(this.actors.view);
    if (this.stage.frames === 1) this.offerFine();
  }

  /** Indices of the robots that are named in the picture: the selected, and that under the pointer. */
  named() {
    const { hovered } = this.pointer;
    const over = hovered?.kind === 'robot' ? hovered.index : -1;
    return new Set([this.details.selectedRobot, over].filter((i) => i >= 0));
  }

  /** What belongs to the selected: its mark, path and scan. */
  showExtras() {
    if (!this.stage) return;
    const thing = this.details.thing;
    const place = thing ? this.world.placeOf(thing) : null;
    this.overlays.select(place, thing?.kind === 'station' ? STATION : thing && halfOf(this.actors.boundsOf(thing)));
    const robot = this.details.selectedRobot;
    const id = this.world.scene.robots[robot];
    if (robot >= 0 && isPressed($('path'))) this.showPath(place, id);
    else this.overlays.showPath(null, []);
    this.showPlanned(id);
    const scan = robot >= 0 && isPressed($('scan')) && this.scans.get(id);
    this.overlays.showScan(scan || null, place);
  }

  /** Where a robot goes: a coordinated one's way is drawn with the others'. */
  showPath(place, id) {
    const way = this.ways.get(id);
    const path = way ? [] : this.paths[id] ?? [];
    this.overlays.showPath(place.slice(0, 2), path, way?.goal);
  }

  /** Where a vehicle of VDA 5050 says that it will drive, beside what was ordered. */
  async showPlanned(id) {
    const planned = isPressed($('path')) ? this.details.plannedOf(id) : null;
    if (!planned && !this.planned) return;
    const { PlannedPath } = await import('./layers/planned.js');
    this.planned ??= new PlannedPath(this.stage);
    this.planned.show(planned);
  }

  /** Ways of the fleet, or of the selected robot alone. */
  async showWays() {
    if (!this.stage || (!this.routes && !this.ways.size)) return;
    const { Ways } = await import('./layers/ways.js');
    this.routes ??= new Ways(this.stage, this.world);
    const id = this.world.scene.robots[this.details.selectedRobot];
    const own = isPressed($('path')) ? [id] : [];
    this.routes.show(this.ways, isPressed($('ways')) ? null : own);
  }

  /** The cells that something can be put on, while it is to be put somewhere. */
  async lightCells() {
    if (!this.stage) return;
    const { FreeCells } = await import('./layers/free_cells.js');
    this.cells ??= new FreeCells(this.stage, this.world, (thing) => this.actors.boundsOf(thing));
    this.cells.show(Boolean(this.placer));
  }

  /** The time that is shown, where that is past [s]; null: now; undefined: of a recording. */
  get moment() {
    const { isLive = true, recording, player } = this.timeline ?? {};
    if (isLive) return null;
    return recording.live ? player.time : undefined;
  }

  // --- the person
  select(name) {
    const isAnother = name !== this.selected;
    this.selected = name;
    if (isAnother) this.details.why = null;
    this.details.show(name);
    this.list.choose(name);
    this.log.drawOwn(name);
    this.watch();
    this.follow(isPressed($('follow')));
    this.showWays();
    this.showExtras();
    this.showDetails(name, isAnother);
    this.stage?.invalidate();
    if (name && isAnother) this.chosenAt = performance.now();
  }

  /** Moves the floor so that the selected does not lie beneath its own panel, which has just grown. */
  uncover() {
    const { thing } = this.details;
    const isNews = performance.now() - this.chosenAt < GROWS;
    if (!isNews || !thing || !this.navigator || this.navigator.flight || isPressed($('follow'))) return;
    const { left, top, bottom, width } = $('details-panel').getBoundingClientRect();
    const [x, y] = this.stage.pixelOf(...this.world.placeOf(thing).slice(0, 3));
    if (width && x > left - ROOM && y > top - ROOM && y < bottom + ROOM) this.navigator.slide(left - 2 * ROOM - x, this.world.placeOf(thing));
  }

  /** Selects what was searched, and flies there. */
  find(name) {
    this.select(name);
    const { thing } = this.details;
    if (thing) this.navigator?.visit(this.world.placeOf(thing), true);
  }

  /** The drawer of the selection opens with another one; it may have been closed since. */
  showDetails(name, isAnother) {
    $('details-tab').hidden = !name;
    if (name && isAnother) this.drawers.open('details-panel');
    else if (!name) this.drawers.close('details-panel');
  }

  /** What waits for a cell to put something there. */
  get placer() {
    return this.placers.find((placer) => placer.wantsCell);
  }

  /** What a click on the floor does: whether it needs a cell, what it says, and does. */
  get wantsCell() {
    return Boolean(this.placer) || isPerson(this.selected) || this.details.selectedRobot >= 0;
  }

  textOf(cell) {
    return `${this.placer ? tr`${this.placer.what} at` : tr`go to`} ${cell.join(', ')}`;
  }

  take(cell, at) {
    if (this.placer) this.placer.place(cell, at);
    else if (isPerson(this.selected)) this.people.go(this.selected, cell, at);
    else this.details.go(...cell, at);
  }

  /** Selects the clicked thing; while a cell is being chosen, says that the thing occupies it. */
  choose(name, at) {
    if (this.placer) this.placer.refuse(tr`${shownName(name)} stands there`, at);
    else this.select(name);
  }

  /** A click that meant nothing. */
  miss(at) {
    this.placer?.refuse(tr`that is beside the floor`, at);
  }

  /** What is the name of nothing that stands there may be a SKU. */
  lookFor(text) {
    clearTimeout(this.typing);
    if (!text && !this.where) return;
    if (text.trim() && !this.fleet.runs) return; // the stock is known only while a coordinator runs
    this.typing = setTimeout(() => this.askWhere(text), text ? TYPING : 0);
  }

  async askWhere(text) {
    const { skuIn, Where } = await import('./layers/where.js');
    this.where ??= new Where(this.stage, this.world, (...pieces) => this.list.showPieces(...pieces), (why) => this.tip.say(why, 'refused'));
    this.where.ask(skuIn(text));
  }

  /** What a warehouse that is built would replace. */
  present() {
    const { robots, units, items } = this.world.scene;
    return { robots: robots.length, shelves: units.length, items: items.length, isWorking: this.fleet.runs };
  }

  goToSearch() {
    this.drawers.open('list-panel');
    $('search').focus();
  }

  leave() {
    if (this.placer) this.wantNone();
    else if (isPressed($('zone'))) this.drawZone(false);
    else this.select(null);
  }

  wantNone() {
    for (const placer of this.placers) placer.want(false);
  }

  /** Asks the server for what the selected needs. */
  watch() {
    const robot = this.details.selectedRobot;
    const id = this.world.scene.robots[robot];
    const want = (button) => (robot >= 0 && isPressed($(button)) ? [id] : []);
    const own = this.fleet.runs && robot >= 0 ? [id] : [];
    const ways = this.fleet.runs && isPressed($('ways')) ? 'all' : own;
    const why = ['robot', 'station'].includes(this.details.thing?.kind) ? this.selected : '';
    this.connection?.watch({ scans: want('scan'), paths: want('path'), ways, why });
  }

  next(step) {
    const { rows } = this.list;
    if (!rows.length) return;
    const at = rows.findIndex((i) => this.list.nameOf(i) === this.selected);
    this.select(this.list.nameOf(rows[(at + step + rows.length) % rows.length]));
    this.speak();
  }

  /** Says the selection to a screen reader. */
  speak() {
    if (this.details.selectedRobot >= 0) speak(this.world, this.details.selectedRobot);
  }

  follow(isOn) {
    const { thing } = this.details;
    press($('follow'), isOn && Boolean(thing));
    this.navigator?.follow(isOn && thing ? () => this.world.placeOf(thing) : null);
  }

  addButtons() {
    toggle('follow', (isOn) => this.follow(isOn));
    for (const id of ['scan', 'path', 'ways']) {
      toggle(id, () => {
        this.watch();
        this.showWays();
        this.showExtras();
      });
    }
    toggle('trails', () => this.showTrails());
    toggle('heat', () => this.showHeat());
    toggle('zone', (isOn) => this.drawZone(isOn));
    toggle('fine', (isOn) => {
      localStorage.setItem('picture', isOn ? 'fine' : 'plain');
      this.showFine(isOn);
    });
    toggle('xray', (isOn) => this.actors?.setSeeThrough(isOn));
    on($('home'), 'click', () => this.showAll(false));
    on($('top'), 'click', () => this.showAll(true));
    on($('theme'), 'click', () => this.changeTheme());
    onTheme(() => this.dress());
    on($('remove'), 'click', () => this.builder.remove(this.selected));
  }

  /** {name, view}: what is selected, and from where all is looked at. */
  looks() {
    return { name: this.selected, view: this.navigator?.view };
  }

  /** Looks as an address says; null: as it does. */
  look({ name, view }) {
    if (name && this.world.indexOf.has(name)) this.select(name);
    if (!view) return;
    this.follow(false);
    this.navigator?.restore(view);
  }

  showAll(above) {
    this.follow(false);
    this.navigator?.showAll(above);
  }

  async showTrails() {
    if (!this.stage) return;
    const { Trails } = await import('./layers/trails.js');
    this.trails ??= new Trails(this.stage, this.world);
    this.trails.want(isPressed($('trails')));
  }

  async showHeat() {
    if (!this.stage) return;
    const { HeatMap } = await import('./layers/heat.js');
    this.heat ??= new HeatMap(this.stage);
    this.heat.want(isPressed($('heat')));
  }

  /** The fine picture comes after the first plain one; where the processor draws it stays plain. */
  offerFine() {
    const lack = drawsInSoftware() ? tr`drawn without a graphics card` : '';
    $('fine').disabled = Boolean(lack); // it commands nothing: a recording has it, too
    if (lack) $('fine').title += tr` – not now: ${lack}`;
    setText($('quality'), lack ? tr`plain, ${lack}` : tr`fine, by the graphics card; Fine among the tools makes it plain`);
    if (!lack && localStorage.getItem('picture') !== 'plain') this.showFine(true);
  }

  async showFine(isOn) {
    press($('fine'), isOn);
    if (!this.stage || (!isOn && !this.fine)) return;
    const { Fine } = await import('./fine/fine.js');
    this.fine ??= new Fine(this);
    this.fine.set(isOn);
  }

  changeTheme() {
    const theme = document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark';
    document.documentElement.dataset.theme = theme;
    localStorage.setItem('theme', theme);
  }

  dress() {
    const { theme } = document.documentElement.dataset;
    this.stage?.setTheme(theme);
    this.overlays?.setTheme(theme);
    this.actors?.setTheme(theme);
    this.fine?.setTheme(theme);
    this.signs?.setTheme(theme);
  }

  refreshPanels() {
    if (document.hidden) return;
    this.isNews = false;
    this.bar.showTime(this.world.stamp);
    this.list.refresh();
    this.details.refresh();
  }
}

/** A button that stays down until it is pressed again. */
function toggle(id, then) {
  on($(id), 'click', () => {
    press($(id), !isPressed($(id)));
    then(isPressed($(id)));
  });
}

function nameIn(hash) {
  try {
    return decodeURIComponent(hash.slice(1));
  } catch { // a lone %
    return '';
  }
}

/** Extent of a thing along the floor, from its bounds [m]. */
function halfOf({ min, max }) {
  return Math.max(...[...min.slice(0, 2), ...max.slice(0, 2)].map(Math.abs));
}

window.page = new Page(); // for a look from the console
if (location.search.includes('kiosk')) import('./kiosk.js');
on(window, 'hashchange', () => window.page.askHash());
