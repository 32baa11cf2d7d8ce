// SPDX-License-Identifier: Apache-2.0
// npm's vda-5050-lib as it comes drives our robots: MasterController, 2.0.0, which checks every
// message. Run by scripts/peers/test-vda5050 with NODE_PATH at the library.
const { readFileSync } = require('node:fs');
const { MasterController } = require('vda-5050-lib');

const [port, file] = process.argv.slice(2);
const site = JSON.parse(readFileSync(file, 'utf8'));
const AHEAD = 4; // nodes released ahead of a robot that drives
const master = new MasterController(
  { interfaceName: 'uagv', transport: { brokerUrl: `mqtt://localhost:${port}` }, vdaVersion: '2.0.0' },
  {},
);
const states = new Map(); // the last one of each robot
const speeds = new Map(); // of each robot since they were cleared [m/s]
const say = (text) => console.log(`lib: ${text}`);
const name = ([column, row]) => `c${column}_${row}`;
const agv = (robot) => ({ manufacturer: 'kiva', serialNumber: String(robot) });

function position([column, row]) {
  const { x, y, spacing } = site.floor;
  return { x: x + column * spacing, y: y + row * spacing, mapId: 'warehouse' };
}

/** Returns an order through cells, with an action at its last node; `released` nodes are its base. */
function order(cells, last, released = cells.length) {
  const nodes = cells.map((cell, k) => ({
    nodeId: name(cell),
    sequenceId: 2 * k,
    released: k < released,
    nodePosition: position(cell),
    actions: last && k === cells.length - 1 ? [last] : [],
  }));
  const edges = nodes.slice(1).map((node, k) => ({
    edgeId: `${nodes[k].nodeId}-${node.nodeId}-${k}`,
    sequenceId: 2 * k + 1,
    released: node.released,
    startNodeId: nodes[k].nodeId,
    endNodeId: node.nodeId,
    actions: [],
  }));
  return { orderId: master.createUuid(), orderUpdateId: 0, nodes, edges };
}

/** Returns the update of an order that releases one node more than the first `released`. */
function extended({ orderId, nodes, edges }, orderUpdateId, released) {
  return {
    orderId,
    orderUpdateId,
    nodes: nodes.slice(released - 1).map((node, k) => ({ ...node, released: k < 2 })),
    edges: edges.slice(released - 1).map((edge, k) => ({ ...edge, released: k < 1 })),
  };
}

function action(actionType, parameters) {
  const actionParameters = Object.entries(parameters).map(([key, value]) => ({ key, value }));
  return { actionType, actionId: master.createUuid(), blockingType: 'HARD', actionParameters };
}

/** Sends an order or an update; resolves to {error, cancelled, traversed} once it was processed. */
function drive(robot, wanted, onNode = () => {}) {
  return new Promise((resolve, reject) => {
    const traversed = [];
    const patience = setTimeout(() => reject(new Error(`${wanted.orderId} took too long`)), 120000);
    master
      .assignOrder(agv(robot), wanted, {
        onOrderProcessed: (error, cancelled, active) => {
          if (active) return;
          clearTimeout(patience);
          resolve({ error, cancelled, traversed });
        },
        onNodeTraversed: (node) => {
          traversed.push(node.nodeId);
          onNode(node, traversed.length);
        },
      })
      .catch(reject);
  });
}

/** Drives through cells, and expects all to go well. */
async function driveWell(robot, cells, last) {
  const { error, cancelled, traversed } = await drive(robot, order(cells, last));
  expect(!error && !cancelled, `robot ${robot}: ${JSON.stringify(error)}`);
  expect(traversed.at(-1) === name(cells.at(-1)), `robot ${robot} went ${traversed}`);
}

function instantly(robot, actionType) {
  const wanted = { actionType, actionId: master.createUuid(), blockingType: 'NONE' };
  return new Promise((resolve, reject) => {
    const done = (state) => ['FINISHED', 'FAILED'].includes(state.actionStatus) && resolve(state);
    master
      .initiateInstantActions(
        agv(robot),
        { instantActions: [wanted] },
        { onActionStateChanged: done, onActionError: reject },
      )
      .catch(reject);
  });
}

function expect(condition, text) {
  if (!condition) throw new Error(text);
}

async function movesAllAtOnce() {
  const steps = Object.entries(site.steps);
  for (const turn of [(way) => way, (way) => way.toReversed()]) {
    await Promise.all(steps.map(([robot, way]) => driveWell(robot, turn(way))));
  }
  say(`${steps.length} robots at once, there and back`);
  expect(steps.length >= 20, 'twenty were to find room');
}

async function bringsUnit({ robot, unit, station, there, onward, back }) {
  const told = { stationType: 'floor', loadType: 'unit', loadId: String(unit) };
  await driveWell(robot, there, action('pick', told));
  await driveWell(robot, onward, action('drop', told));
  say(`robot ${robot} brought unit ${unit} to ${station}`);
  await driveWell(robot, [onward.at(-1)], action('pick', told));
  await driveWell(robot, back, action('drop', told));
  say('and back');
}

/** Drives a straight whose nodes are released one at a time, while the robot drives. */
async function extendsWithoutADip({ robot, approach, straight }) {
  await driveWell(robot, approach);
  const whole = order(straight, undefined, AHEAD);
  let released = AHEAD;
  let last;
  const extend = (node) => {
    if (released === straight.length || node.sequenceId / 2 < released - AHEAD + 1) return;
    expect(states.get(robot).driving, 'it stands, and the next node comes only now');
    last = drive(robot, extended(whole, released - AHEAD + 1, released), extend);
    released += 1;
  };
  speeds.set(robot, []);
  drive(robot, whole, extend);
  while (released < straight.length) await new Promise((resolve) => setTimeout(resolve, 20));
  const { error } = await last;
  expect(!error, JSON.stringify(error));
  const told = speeds.get(robot);
  const top = Math.max(...told);
  const isFast = (speed) => speed > 0.99 * top;
  const fast = told.slice(told.findIndex(isFast), told.findLastIndex(isFast) + 1);
  const least = Math.min(...fast);
  const figures = `top ${top.toFixed(2)} m/s, least between ${least.toFixed(2)} m/s, ${fast.length} states`;
  say(`${straight.length} nodes, ${released - AHEAD} updates while it drove: ${figures}`);
  expect(least > 0.97 * top && fast.length > 10, `${told}`);
}

async function pausesAndCancels({ robot, straight }) {
  const way = order(straight.toReversed());
  let paused;
  const ended = await drive(robot, way, async (_, count) => {
    if (count !== 3) return;
    paused = await instantly(robot, 'startPause');
    expect(!states.get(robot).driving, 'it drives on');
    say(`robot ${robot} is paused`);
    await instantly(robot, 'stopPause');
    await instantly(robot, 'cancelOrder');
  });
  expect(paused?.actionStatus === 'FINISHED', 'it was to be paused');
  expect(ended.cancelled, 'the order was to be cancelled');
  const at = states.get(robot).lastNodeId;
  expect(at !== way.nodes[0].nodeId && at !== way.nodes.at(-1).nodeId, `it stands at ${at}`);
  say(`robot ${robot} was cancelled at ${at}`);
}

async function refuses({ robot }) {
  const here = states.get(robot).lastNodeId.slice(1).split('_').map(Number);
  const [column, row] = here;
  const unknown = order([here, [column + 1, row]]);
  unknown.nodes[1].nodeId = unknown.edges[0].endNodeId = 'gate';
  delete unknown.nodes[1].nodePosition;
  const bad = [
    ['off the floor', order([here, [column, row + 1000]]), 'orderError'],
    ['diagonal', order([here, [column + 1, row + 1]]), 'orderError'],
    ['unknown node', unknown, 'orderError'],
    ['elsewhere', order([[column + 3, row], [column + 4, row]]), 'noRouteError'],
    ['lower update', undefined, 'orderUpdateError'],
  ];
  for (const [what, wanted, type] of bad) {
    let sent = wanted;
    if (!sent) {
      sent = { ...order([here]), orderUpdateId: 2 };
      await drive(robot, { ...sent, orderUpdateId: 3 });
    }
    const { error } = await drive(robot, sent);
    expect(error?.errorType === type, `${what}: ${JSON.stringify(error)}`);
    say(`${what}: ${type}: ${error.errorDescription}`);
  }
}

async function main() {
  await master.start();
  await master.subscribe('state', {}, (state) => {
    const robot = Number(state.serialNumber);
    states.set(robot, state);
    speeds.get(robot)?.push(Math.abs(state.velocity?.vx ?? 0));
  });
  const trip = site.trips[1];
  await movesAllAtOnce();
  await bringsUnit(trip);
  await extendsWithoutADip(trip);
  await pausesAndCancels(trip);
  await refuses(trip);
  await master.stop();
  say('done');
}

main().then(
  () => process.exit(0),
  (error) => {
    console.error(`lib: ${error.stack ?? JSON.stringify(error)}`);
    process.exit(1);
  },
);
