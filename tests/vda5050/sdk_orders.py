# SPDX-License-Identifier: Apache-2.0
"""PyPI's vda5050-sdk as it comes is a master: MasterClient, 2.1.0, which gives vehicles one order
after another, for conform --master to try. Ends by Ctrl-C.

Arguments: the broker's port, and serial numbers of vehicles of `acme`. Vehicle n has a row of six
nodes on the map `hall`, rNn0 at (0, 3n) to rNn5 at (7.5, 3n). By turns it drives along it and
lifts."""

import asyncio
import itertools
import math
import sys
import time

from vda5050.client.master import MasterClient
from vda5050.config import MasterConfig
from vda5050.domain.order.builder import OrderBuilder
from vda5050.model.common import Action, ActionParameter
from vda5050.model.enums import BlockingType

PORT, *SERIALS = sys.argv[1:]
MAP, COUNT, SPACING = "hall", 6, 1.5
AHEAD = 3  # nodes released at first, and ahead of a vehicle that drives
PATIENCE = 60.0  # for an order, until it is cancelled [s]
STUCK = 10.0  # without a node passed, until an order is cancelled [s]
PAUSE = 3.0  # after an order that was refused [s]
OVER = {"FINISHED", "FAILED"}
DRIVEN = {"AUTOMATIC", "SEMIAUTOMATIC"}


def place(serial, k):
    return {"x": k * SPACING, "y": 3.0 * int(serial), "map_id": MAP}


def name(serial, k):
    return f"r{serial}n{k}"


def order(serial, way, action=None):
    """Returns an order along nodes of a vehicle's row; its first nodes are released."""
    builder = OrderBuilder(
        order_id=f"order-{serial}-{time.time_ns()}", manufacturer="acme", serial_number=serial
    )
    for i, k in enumerate(way):
        actions = [action] if action and i == len(way) - 1 else []
        released = i < AHEAD
        builder.add_node(name(serial, k), released=released, actions=actions, **place(serial, k))
    names = [name(serial, k) for k in way]
    for i, (a, b) in enumerate(itertools.pairwise(names)):
        builder.add_edge(a, b, edge_id=f"{a}-{b}", released=i + 1 < AHEAD)
    return builder.build()


def lift(kind):
    return Action(
        action_type=kind,
        action_id=f"{kind}-{time.time_ns()}",
        blocking_type=BlockingType.HARD,
        action_parameters=[
            ActionParameter(key="stationType", value="floor"),
            ActionParameter(key="loadType", value="unit"),
        ],
    )


class Driver:
    """Gives orders to one vehicle while it is ONLINE, not a person's, localized, and whole."""

    def __init__(self, client, serial):
        self.client, self.serial, self.key = client, serial, f"acme/{serial}"
        self.state, self.online = None, False

    def is_ready(self):
        state = self.state
        if not (self.online and state and state.agv_position):
            return False
        fatal = any(error.error_level.value == "FATAL" for error in state.errors)
        is_whole = state.agv_position.position_initialized and not fatal and not state.paused
        return is_whole and state.operating_mode.value in DRIVEN and self.is_over()

    def is_over(self, order_id=None):
        state = self.state
        return (
            (order_id is None or state.order_id == order_id)
            and not state.node_states
            and not state.driving
            and all(action.action_status.value in OVER for action in state.action_states)
        )

    def here(self):
        """The node that the vehicle is nearest to."""
        at = self.state.agv_position
        return min(range(COUNT), key=lambda k: math.dist((at.x, at.y), self._at(k)))

    def _at(self, k):
        return k * SPACING, 3.0 * int(self.serial)

    async def until(self, condition, seconds):
        end = time.monotonic() + seconds
        while not condition() and time.monotonic() < end:
            await asyncio.sleep(0.02)
        return condition()

    async def run(self):
        for turn in itertools.count():
            await self.until(self.is_ready, math.inf)
            here = self.here()
            goal = (here + (2, 5, 3)[turn % 3]) % COUNT
            step = 1 if goal > here else -1
            way = [here] if turn % 4 == 3 else [*range(here, goal + step, step)]
            kind = "drop" if self.state.loads else "pick"
            await self.drive(order(self.serial, way, lift(kind) if turn % 2 else None))
            await asyncio.sleep(0.5)

    async def drive(self, whole):
        """Sends an order, releases node by node, and cancels what does not come to its end."""
        result = await self.client.dispatch(whole, self.key)
        if not result.accepted:
            print(f"sdk: {self.key}: {result}", flush=True)
        elif await self.until(lambda: self.has(whole), 5.0):
            await self.accompany(whole)
        if not self.has(whole):
            await asyncio.sleep(PAUSE)
        elif self.online and not self.is_over():
            await self.client.cancel_order(self.key, action_id=f"cancel-{time.time_ns()}")
            await self.until(self.is_over, STUCK)

    def has(self, whole):
        return self.state.order_id == whole.order_id

    async def accompany(self, whole):
        """Releases node by node while the vehicle drives, until its order ends or it is stuck."""
        end = time.monotonic() + PATIENCE
        for k in range(AHEAD, len(whole.nodes)):
            is_due = await self.until(lambda k=k: self.passed(whole, k - AHEAD), STUCK)
            if not (is_due and self.online):
                return
            await self.extend(whole, k)
        await self.until(lambda: self.is_over(whole.order_id), end - time.monotonic())

    def passed(self, whole, k):
        """Whether the vehicle has an order still, and has passed more than k edges of it."""
        return self.has(whole) and self.state.last_node_sequence_id > 2 * k

    async def extend(self, whole, k):
        """Releases node k of an order too."""
        nodes = [n.model_copy(update={"released": n is whole.nodes[k]}) for n in whole.nodes[k:]]
        edges = [
            e.model_copy(update={"released": e is whole.edges[k - 1]}) for e in whole.edges[k - 1 :]
        ]
        result = await self.client.extend_base(self.key, nodes, edges)
        if not result.accepted:
            print(f"sdk: {self.key}: {result}", flush=True)


async def main():
    config = MasterConfig(broker_url=f"mqtt://localhost:{PORT}", progress_monitor=False)
    client = MasterClient(config)
    drivers = {serial: Driver(client, serial) for serial in SERIALS}

    def on_state(state, key):
        if driver := drivers.get(key.serial_number):
            driver.state = state

    def on_connection(connection, key):
        if driver := drivers.get(key.serial_number):
            driver.online = connection.connection_state.value == "ONLINE"

    client.on_state(on_state)
    client.on_connection(on_connection)
    async with client:
        await asyncio.gather(*(driver.run() for driver in drivers.values()))


asyncio.run(main())
