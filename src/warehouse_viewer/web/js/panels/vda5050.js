// SPDX-License-Identifier: Apache-2.0
// Facts of robots at a broker by VDA 5050, for the panel of the selection.

import { get } from '../base/api.js';
import { tr } from '../language/texts.js';

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
  if (robot.order) out.push([tr`order`, robot.order]);
  for (const error of robot.errors) out.push([tr`error`, error]);
  for (const fault of robot.faults ?? []) out.push([tr`fault`, fault]);
  return out;
}

/** Whether a robot is a vehicle that an outside master may drive, so that faults can be asked for. */
export const isVehicle = (id) => robots.get(id)?.driven_by === 'OUTSIDE_MASTER';

const robots = new Map();
let asked = -Infinity;

/** Facts of the robot of that id; asks the server again every PERIOD, for the next call. */
export function vda5050Of(id, now = performance.now()) {
  if (now - asked > PERIOD) {
    asked = now;
    get('/vda5050').then((rows) => {
      robots.clear();
      for (const robot of rows) robots.set(robot.id, robot);
    }, () => robots.clear());
  }
  return factsOf(robots.get(id));
}
