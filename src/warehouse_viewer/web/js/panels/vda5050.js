// SPDX-License-Identifier: Apache-2.0
// Facts of robots at a broker by VDA 5050, for the panel of the selection.

import { get } from '../base/api.js';
import { ask } from '../base/request.js';
import { number } from '../language/numbers.js';
import { tr } from '../language/texts.js';

const MOST_NODES = 6; // of a base or a horizon that are named
const NEAR = 0.2; // change of a past moment up to which the last answer does [s]
const PERIOD = 2000; // between two questions, while a robot is selected [ms]
const CONNECTION = { ONLINE: tr`online`, OFFLINE: tr`offline`, CONNECTIONBROKEN: tr`connection broken` };

/** Facts of one robot, as [what, text]; none of a robot at no broker. */
export function factsOf(robot) {
  if (!robot) return [];
  const outside = robot.driven_by === 'OUTSIDE_MASTER';
  const by = outside ? (robot.driven ? tr`an outside master` : tr`no outside master now`) : tr`this warehouse`;
  const out = [
    [tr`VDA 5050`, tr`${robot.manufacturer}/${robot.serial} at ${robot.broker}: ${CONNECTION[robot.connection]}`],
    [tr`driven by`, by],
  ];
  if (robot.order) out.push([tr`order`, robot.past ? tr`${robot.order}, update ${robot.past.update}` : robot.order]);
  if (robot.past) out.push(...factsOfPast(robot.past));
  out.push(...factsOfPlan(robot));
  for (const error of robot.errors) out.push([tr`error`, error]);
  for (const fault of robot.faults ?? []) out.push([tr`fault`, fault]);
  return out;
}

/** Where a vehicle of 3.0.0 says that it will drive, and when it will be there. */
function factsOfPlan({ planned_path: path = [], intermediate_path: points = [] }) {
  const out = path.length ? [[tr`planned path`, tr`${path.length} points`]] : [];
  const last = points.at(-1);
  if (last) out.push([tr`reaches`, tr`${number(last.x, 1)}, ${number(last.y, 1)} m at ${clock(last.time)}`]);
  return out;
}

/** A time on the wall [s since 1970], with seconds. */
const clock = (seconds) => new Date(seconds * 1000).toLocaleTimeString();

/** What a state of a recording says besides. */
function factsOfPast({ base, horizon, last_node, driving, paused, mode, actions, age }) {
  const out = [];
  if (last_node) out.push([tr`last node`, last_node]);
  if (base.length) out.push([tr`base`, nodes(base)]);
  if (horizon.length) out.push([tr`horizon`, nodes(horizon)]);
  if (age !== null) {
    const does = paused ? tr`paused` : driving ? tr`driving` : tr`standing`;
    out.push([tr`state`, tr`${[does, mode].filter(Boolean).join(', ')}, ${number(age, 1)} s old`]);
  }
  for (const action of actions) out.push([tr`action`, action]);
  return out;
}

/** The nodes of a stretch ahead, the nearest first; of a long one the first and the last. */
function nodes(names) {
  const shown = names.length <= MOST_NODES ? names : [...names.slice(0, MOST_NODES - 2), '…', names.at(-1)];
  return `${shown.join(' → ')} (${names.length})`;
}

/** Whether a robot is a vehicle that an outside master may drive, so that faults can be asked for. */
export const isVehicle = (id) => robots.get(id)?.driven_by === 'OUTSIDE_MASTER';

/** The robot of that id as the server has it, where it is a vehicle of 3.0.0 that says where it will drive:
 *  planned_path, [[x, y], …], and intermediate_path, [{x, y, time}, …]; null: it does not. */
export function plannedOf(id) {
  const robot = robots.get(id);
  return robot?.planned_path?.length || robot?.intermediate_path?.length ? robot : null;
}

const robots = new Map();
let asked = -Infinity;

/** Facts of the robot of that id; asks the server again every PERIOD, for the next call.
 *  `past`: the moment that is shown, on the wall [s since 1970], null: now, undefined: not known;
 *  changed() is called when an answer about that has come. */
export function vda5050Of(id, { now = performance.now(), past = null, changed = () => {} } = {}) {
  if (past !== null) return pastOf(id, past, changed);
  if (shownPast !== null) leavePast();
  if (now - asked > PERIOD) {
    asked = now;
    get('/vda5050').then((rows) => {
      robots.clear();
      for (const robot of rows) robots.set(robot.id, robot);
    }, () => robots.clear());
  }
  return factsOf(robots.get(id));
}

let shownPast = null; // the moment of `robots`, NaN: none is known; null: they are of now
let isAsking = false;

function leavePast() {
  robots.clear();
  [shownPast, asked] = [null, -Infinity];
}

/** Facts at a past moment; of many moments that come while an answer is awaited the last counts. */
function pastOf(id, past, changed) {
  if (past === undefined) {
    robots.clear();
    shownPast = NaN;
  } else if (!isAsking && !(Math.abs(past - shownPast) <= NEAR && shownPast !== null)) {
    isAsking = true;
    if (shownPast === null) robots.clear();
    shownPast = past;
    ask('GET', `/recording/vda5050?at=${past.toFixed(3)}`).catch(() => []).then((rows) => {
      isAsking = false;
      if (shownPast !== past) return;
      robots.clear();
      for (const robot of rows) robots.set(robot.id, robot);
      changed();
    });
  }
  return factsOf(robots.get(id));
}
