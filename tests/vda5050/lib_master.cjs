// SPDX-License-Identifier: Apache-2.0
// npm's vda-5050-lib as it comes drives our robots: MasterController, 2.0.0, which checks every
// message. Run by scripts/test-vda5050 with NODE_PATH at the library.
const { readFileSync } = require('node:fs');
const { MasterController } = require('vda-5050-lib');

const [port, file] = process.argv.slice(2);
const site = JSON.parse(readFileSync(file, 'utf8'));
const say = (text) => console.log(`lib: ${text}`);
const name = ([column, row]) => `c${column}_${row}`;

function position([column, row]) {
  const { x, y, spacing } = site.floor;
  return { x: x + column * spacing, y: y + row * spacing, mapId: 'warehouse' };
}

/** Returns an order through cells, with an action at its last node. */
function order(master, cells, last) {
  const nodes = cells.map((cell, k) => ({
    nodeId: name(cell),
    sequenceId: 2 * k,
    released: true,
    nodePosition: position(cell),
    actions: last && k === cells.length - 1 ? [last] : [],
  }));
  const edges = nodes.slice(1).map((node, k) => ({
    edgeId: `${nodes[k].nodeId}-${node.nodeId}-${k}`,
    sequenceId: 2 * k + 1,
    released: true,
    startNodeId: nodes[k].nodeId,
    endNodeId: node.nodeId,
    actions: [],
  }));
  return { orderId: master.createUuid(), orderUpdateId: 0, nodes, edges };
}

function action(master, actionType, parameters) {
  const actionParameters = Object.entries(parameters).map(([key, value]) => ({ key, value }));
  return { actionType, actionId: master.createUuid(), blockingType: 'HARD', actionParameters };
}

/** Drives an order; resolves to {error, cancelled, traversed} once it was processed. */
function drive(master, agv, wanted, onNode = () => {}) {
  return new Promise((resolve, reject) => {
    const traversed = [];
    const patience = setTimeout(() => reject(new Error(`${wanted.orderId} took too long`)), 120000);
    master
      .assignOrder(agv, wanted, {
        onOrderProcessed: (error, cancelled, active) => {
          if (active) return;
          clearTimeout(patience);
          resolve({ error, cancelled, traversed });
        },
        onNodeTraversed: (node) => {
          traversed.push(node.nodeId);
          onNode(node);
        },
      })
      .catch(reject);
  });
}

function instantly(master, agv, actionType) {
  const wanted = { actionType, actionId: master.createUuid(), blockingType: 'NONE' };
  return new Promise((resolve, reject) => {
    const done = (state) => ['FINISHED', 'FAILED'].includes(state.actionStatus) && resolve(state);
    master
      .initiateInstantActions(
        agv,
        { instantActions: [wanted] },
        { onActionStateChanged: done, onActionError: reject },
      )
      .catch(reject);
  });
}

function expect(condition, text) {
  if (!condition) throw new Error(text);
}

async function main() {
  const master = new MasterController(
    { interfaceName: 'uagv', transport: { brokerUrl: `mqtt://localhost:${port}` }, vdaVersion: '2.0.0' },
    {},
  );
  await master.start();
  const trip = site.trips[1] ?? site.trips[0];
  const agv = { manufacturer: 'kiva', serialNumber: String(trip.robot) };
  const lift = action(master, 'pick', { stationType: 'place', loadType: 'unit', loadId: String(trip.unit) });
  const lower = action(master, 'drop', { stationType: 'floor', loadType: 'unit' });
  for (const [cells, last] of [[trip.there, lift], [trip.onward, lower]]) {
    const { error, traversed } = await drive(master, agv, order(master, cells, last));
    expect(!error, JSON.stringify(error));
    expect(traversed.length >= cells.length - 1, `${traversed.length} nodes of ${cells.length}`);
  }
  say(`robot ${trip.robot} brought unit ${trip.unit} to ${trip.station}`);

  const pickAgain = action(master, 'pick', { stationType: 'floor', loadType: 'unit', loadId: String(trip.unit) });
  await drive(master, agv, order(master, [trip.onward.at(-1)], pickAgain));
  let asked = false;
  const way = order(master, trip.back);
  const ended = await drive(master, agv, way, async () => {
    if (asked) return;
    asked = true;
    const paused = await instantly(master, agv, 'startPause');
    expect(paused.actionStatus === 'FINISHED', 'paused');
    say(`robot ${trip.robot} is paused`);
    await instantly(master, agv, 'stopPause');
    await instantly(master, agv, 'cancelOrder');
  });
  expect(ended.cancelled, 'the order was to be cancelled');
  say(`robot ${trip.robot} was cancelled in mid-way`);

  const far = order(master, [trip.there[0], [trip.there[0][0], 100000]]);
  const refused = await drive(master, agv, far);
  expect(refused.error?.errorType === 'orderError', JSON.stringify(refused));
  say(`refused: ${refused.error.errorDescription}`);
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
