// SPDX-License-Identifier: Apache-2.0
// npm's vda-5050-lib as it comes is a vehicle: AgvController with VirtualAgvAdapter, 2.0.0.
// Arguments: the broker's port, serial number, x, y [m] and the node where it stands.
const { AgvController, VirtualAgvAdapter } = require('vda-5050-lib');

const [port, serialNumber, x, y, lastNodeId] = process.argv.slice(2);
const vehicle = new AgvController(
  { manufacturer: 'lib', serialNumber },
  { interfaceName: 'uagv', transport: { brokerUrl: `mqtt://localhost:${port}` }, vdaVersion: '2.0.0' },
  { agvAdapterType: VirtualAgvAdapter },
  {
    initialPosition: { mapId: 'hall', x: Number(x), y: Number(y), theta: 0, lastNodeId },
    vehicleSpeed: 1.5,
    tickRate: 20,
  },
);
vehicle.start();
