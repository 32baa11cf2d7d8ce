# SPDX-License-Identifier: Apache-2.0
"""PyPI's vda5050-sdk as it comes is a vehicle: FakeAgv, 2.1.0, which goes from node to node.

Arguments: the broker's port, serial number, x, y [m] and the node where it stands."""

import asyncio
import sys

from vda5050.adapters.mqtt.transport import AiomqttTransport
from vda5050.config import VehicleConfig
from vda5050.testing.fake_agv import FakeAgv

PORT, SERIAL, X, Y, NODE = sys.argv[1:]
URL = f"mqtt://localhost:{PORT}"


class RealBroker:
    """Where FakeAgv expects a broker in memory: connects it to a real one."""

    def attach(self, _transport):
        return AiomqttTransport(URL)


async def main():
    vehicle = FakeAgv(
        VehicleConfig(broker_url=URL, manufacturer="sdk", serial_number=SERIAL),
        RealBroker(),
        node_delay=0.7,
        action_delay=2.0,
        initial_node_id=NODE,
        start_x=float(X),
        start_y=float(Y),
        start_map_id="hall",
    )
    await vehicle.start()
    await asyncio.Event().wait()


asyncio.run(main())
