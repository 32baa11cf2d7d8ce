// SPDX-License-Identifier: Apache-2.0
// npm's vda-5050-lib as it comes is a master: MasterController, 2.0.0, which gives vehicles one order
// after another, for conform --master to try. Ends by Ctrl-C.
//
// Arguments: the broker's port, and serial numbers of vehicles of `acme`. Vehicle n has a row of six
// nodes on the map `hall`, rNn0 at (0, 3n) to rNn5 at (7.5, 3n). By turns it drives along it and lifts.
const { MasterController } = require('vda-5050-lib');

const [port, ...serials] = process.argv.slice(2);
const COUNT = 6;
const SPACING = 1.5; // [m]
const AHEAD = 3; // nodes released at first, and ahead of a vehicle that drives
const PATIENCE = 60000; // for an order, until it is cancelled [ms]
const STUCK = 10000; // without a node passed, until an order is cancelled [ms]
const PAUSE = 3000; // after an order that was refused [ms]
const DRIVEN = ['AUTOMATIC', 'SEMIAUTOMATIC'];
const master = new MasterController(
  { interfaceName: 'uagv', transport: { brokerUrl: `mqtt://localhost:${port}` }, vdaVersion: '2.0.0' },
  {},
);
const quiet = { onActionStateChanged: () => {}, onActionError: () => {} }; // states say how it ends
const states = new Map();
const online = new Set();
const agv = (serialNumber) => ({ manufacturer: 'acme', serialNumber });
const place = (serial, k) => ({ x: k * SPACING, y: 3 * Number(serial), mapId: 'hall' });
const rest = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

async function until(condition, milliseconds = Infinity) {
  const end = Date.now() + milliseconds;
  while (!condition() && Date.now() < end) await rest(20);
  return condition();
}

function isOver(state) {
  const left = state.actionStates.some((a) => !['FINISHED', 'FAILED'].includes(a.actionStatus));
  return !state.nodeStates.length && !state.driving && !left;
}

/** Whether an order may be given: ONLINE, not a person's, localized, not broken, and none under way. */
function isReady(serial) {
  const state = states.get(serial);
  if (!online.has(serial) || !state?.agvPosition?.positionInitialized || state.paused) return false;
  const fatal = state.errors.some((error) => error.errorLevel === 'FATAL');
  return DRIVEN.includes(state.operatingMode) && !fatal && isOver(state);
}

/** Returns the node that a vehicle is nearest to. */
function here(serial) {
  const at = states.get(serial).agvPosition;
  const off = (k) => Math.hypot(at.x - place(serial, k).x, at.y - place(serial, k).y);
  return [...Array(COUNT).keys()].reduce((best, k) => (off(k) < off(best) ? k : best), 0);
}

function lift(serial) {
  const loaded = states.get(serial).loads?.length;
  return {
    actionType: loaded ? 'drop' : 'pick',
    actionId: master.createUuid(),
    blockingType: 'HARD',
    actionParameters: [
      { key: 'stationType', value: 'floor' },
      { key: 'loadType', value: 'unit' },
    ],
  };
}

/** Returns an order along nodes of a vehicle's row; its first nodes are released. */
function order(serial, way, action) {
  const nodes = way.map((k, i) => ({
    nodeId: `r${serial}n${k}`,
    sequenceId: 2 * i,
    released: i < AHEAD,
    nodePosition: place(serial, k),
    actions: action && i === way.length - 1 ? [action] : [],
  }));
  const edges = nodes.slice(1).map((node, i) => ({
    edgeId: `${nodes[i].nodeId}-${node.nodeId}`,
    sequenceId: 2 * i + 1,
    released: node.released,
    startNodeId: nodes[i].nodeId,
    endNodeId: node.nodeId,
    actions: [],
  }));
  return { orderId: master.createUuid(), orderUpdateId: 0, nodes, edges };
}

/** Returns the update that releases one node more than the first `count`. */
function extended({ orderId, nodes, edges }, orderUpdateId, count) {
  return {
    orderId,
    orderUpdateId,
    nodes: nodes.slice(count - 1).map((node, k) => ({ ...node, released: k < 2 })),
    edges: edges.slice(count - 1).map((edge, k) => ({ ...edge, released: k < 1 })),
  };
}

/** Assigns an order or an update; calls ended() once the library says that it is processed. */
function assign(serial, sent, ended) {
  return master.assignOrder(agv(serial), sent, {
    onOrderProcessed: (error, cancelled, active) => !active && ended(error, cancelled),
  });
}

/** Sends an order, releases node by node, and cancels what does not come to its end. */
async function drive(serial, whole) {
  let over = false;
  const ended = () => (over = true);
  const has = () => states.get(serial).orderId === whole.orderId;
  await assign(serial, whole, ended);
  await accompany(serial, whole, has, () => over, ended);
  if (!has()) return rest(PAUSE);
  if (online.has(serial) && !isOver(states.get(serial))) {
    const actionId = master.createUuid();
    const cancel = { actionType: 'cancelOrder', actionId, blockingType: 'HARD' };
    await master.initiateInstantActions(agv(serial), { instantActions: [cancel] }, quiet);
    await until(() => isOver(states.get(serial)), STUCK);
  }
}

/** Releases node by node while a vehicle drives; ends with the order, or if it is stuck. */
async function accompany(serial, whole, has, isDone, ended) {
  for (let count = AHEAD; count < whole.nodes.length && !isDone(); count++) {
    const isDue = () => has() && states.get(serial).lastNodeSequenceId > 2 * (count - AHEAD);
    await until(() => isDone() || isDue(), STUCK);
    if (isDone() || !isDue() || !online.has(serial)) return;
    await assign(serial, extended(whole, count - AHEAD + 1, count), ended);
  }
  await until(isDone, PATIENCE);
}

async function run(serial) {
  for (let turn = 0; ; turn++) {
    await until(() => isReady(serial));
    const start = here(serial);
    const goal = (start + [2, 5, 3][turn % 3]) % COUNT;
    const step = goal > start ? 1 : -1;
    const way = [start];
    if (turn % 4 !== 3) for (let k = start; k !== goal; k += step) way.push(k + step);
    await drive(serial, order(serial, way, turn % 2 ? lift(serial) : undefined)).catch((error) =>
      console.log(`lib: ${serial}: ${error.message ?? JSON.stringify(error)}`),
    );
    await rest(500);
  }
}

async function main() {
  await master.start();
  await master.subscribe('state', {}, (state) => states.set(state.serialNumber, state));
  await master.subscribe('connection', {}, ({ serialNumber, connectionState }) =>
    connectionState === 'ONLINE' ? online.add(serialNumber) : online.delete(serialNumber),
  );
  await Promise.all(serials.map(run));
}

main().catch((error) => {
  console.error(`lib: ${error.stack ?? JSON.stringify(error)}`);
  process.exit(1);
});
