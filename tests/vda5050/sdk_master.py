# SPDX-License-Identifier: Apache-2.0
"""PyPI's vda5050-sdk as it comes drives our robots: MasterClient, 2.1.0, checking every message
against the official schemas. Run by scripts/peers/test-vda5050 in the sdk's own environment.

Arguments: the broker's port, the file that floor.py wrote; fetch: no more than that."""

import asyncio
import json
import sys
import time
from functools import partial
from pathlib import Path

from vda5050.client.master import MasterClient
from vda5050.config import MasterConfig
from vda5050.domain.order.builder import OrderBuilder
from vda5050.identity import VehicleKey
from vda5050.model.common import Action, ActionParameter
from vda5050.model.enums import BlockingType

PORT = int(sys.argv[1])
SITE = json.loads(Path(sys.argv[2]).read_text())
FLOOR = SITE["floor"]
MAP = "warehouse"
AHEAD = 4  # nodes released ahead of a robot that drives


def say(text):
    print(f"sdk: {text}", flush=True)


def action(kind, **parameters):
    listed = [ActionParameter(key=k, value=v) for k, v in parameters.items()]
    return Action(
        action_type=kind,
        action_id=f"{kind}-{time.time_ns()}",
        blocking_type=BlockingType.HARD,
        action_parameters=listed,
    )


def position(cell):
    x, y = FLOOR["x"] + cell[0] * FLOOR["spacing"], FLOOR["y"] + cell[1] * FLOOR["spacing"]
    return {"x": x, "y": y, "map_id": MAP}


def name(cell):
    return f"c{cell[0]}_{cell[1]}"


def order(robot, cells, released=None, last=None, order_id=None):
    """Returns an order through cells; `last` is the action at the last of them."""
    released = len(cells) if released is None else released
    builder = OrderBuilder(
        order_id=order_id or f"order-{time.time_ns()}", manufacturer="kiva", serial_number=robot
    )
    for k, cell in enumerate(cells):
        actions = [last] if last and k == len(cells) - 1 else []
        builder.add_node(name(cell), released=k < released, actions=actions, **position(cell))
    for k, (a, b) in enumerate(zip(cells, cells[1:])):
        edge = f"{name(a)}-{name(b)}-{k}"
        builder.add_edge(name(a), name(b), edge_id=edge, released=k + 1 < released)
    return builder.build()


class Peer:
    """The MasterClient, and what it was told."""

    def __init__(self):
        config = MasterConfig(
            broker_url=f"mqtt://localhost:{PORT}", validate_messages=True, progress_monitor=False
        )
        self.client = MasterClient(config)
        self.states, self.errors, self.faults = {}, [], []
        self.speeds = []
        self.client.on_state(self._on_state)
        self.client.on_vehicle_error(lambda event, key: self.errors.append((str(key), event)))
        self.client.on_error(self.faults.append)

    def _on_state(self, state, key):
        self.states[key.serial_number] = state
        if state.velocity:
            speed = (time.monotonic(), key.serial_number, abs(state.velocity.vx or 0.0))
            self.speeds.append(speed)

    async def until(self, condition, seconds=90.0, what=""):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, f"{what} in vain; errors: {self.errors[-3:]}"
            await asyncio.sleep(0.02)

    def over(self, robot, order_id):
        state = self.states.get(robot)
        ended = {"FINISHED", "FAILED"}
        return (
            state
            and state.order_id == order_id
            and not state.node_states
            and all(a.action_status.value in ended for a in state.action_states)
            and not state.driving
        )

    def passed(self, robot, order_id):
        """How many nodes of an order the robot has passed, but the one it began at."""
        state = self.states[robot]
        return state.last_node_sequence_id // 2 if state.order_id == order_id else 0

    async def drive(self, robot, cells, **options):
        sent = order(robot, cells, **options)
        result = await self.client.dispatch(sent, f"kiva/{robot}")
        assert result.accepted, result
        await self.until(lambda: self.over(robot, sent.order_id), what=f"order of {robot}")
        failed = [a for a in self.states[robot].action_states if a.action_status.value == "FAILED"]
        assert not failed, failed


async def fetches_carries_drops(peer, trip):
    robot = str(trip["robot"])
    start = time.monotonic()
    await peer.drive(robot, trip["there"], last=action("pick", loadId=str(trip["unit"])))
    assert [load.load_id for load in peer.states[robot].loads] == [str(trip["unit"])]
    await peer.drive(robot, trip["onward"], last=action("drop", stationType="floor"))
    assert not peer.states[robot].loads
    say(
        f"robot {robot} brought unit {trip['unit']} to {trip['station']} in "
        f"{time.monotonic() - start:.1f} s"
    )
    await peer.drive(robot, [trip["onward"][-1]], last=action("pick", loadId=trip["unit"]))
    await peer.drive(robot, trip["back"], last=action("drop"))
    say("and back")


async def extends_without_a_dip(peer, trip):
    """Drives a straight whose nodes are released one at a time, while it drives."""
    robot, way = str(trip["robot"]), trip["straight"]
    await peer.drive(robot, trip["approach"])
    whole = order(robot, way, released=AHEAD)
    peer.speeds.clear()
    assert (await peer.client.dispatch(whole, f"kiva/{robot}")).accepted
    for k in range(AHEAD, len(way)):
        await peer.until(lambda k=k: peer.passed(robot, whole.order_id) > k - AHEAD, what="a node")
        assert peer.states[robot].driving, "it stands, and the next node comes only now"
        nodes = [n.model_copy(update={"released": n is whole.nodes[k]}) for n in whole.nodes[k:]]
        edges = [
            e.model_copy(update={"released": e is whole.edges[k - 1]}) for e in whole.edges[k - 1 :]
        ]
        result = await peer.client.extend_base(f"kiva/{robot}", nodes, edges)
        assert result.accepted, result
    await peer.until(lambda: peer.over(robot, whole.order_id), what="the end")
    assert peer.states[robot].order_update_id == len(way) - AHEAD
    speeds = [v for _, serial, v in peer.speeds if serial == robot]
    top = max(speeds)
    first, last = (f(k for k, v in enumerate(speeds) if v > 0.99 * top) for f in (min, max))
    dip = min(speeds[first : last + 1])
    say(
        f"{len(way)} nodes, {AHEAD} ahead, {len(way) - AHEAD} updates while it drove:"
        f" top {top:.2f} m/s, least between {dip:.2f} m/s, {last - first + 1} states"
    )
    assert dip > 0.97 * top and last - first > 10, speeds


async def pauses_and_cancels(peer, trip):
    robot, way = str(trip["robot"]), trip["straight"][::-1]
    sent = order(robot, way)
    assert (await peer.client.dispatch(sent, f"kiva/{robot}")).accepted
    await peer.until(lambda: peer.passed(robot, sent.order_id) >= 2, what="the second node")
    await peer.client.pause(f"kiva/{robot}")
    await peer.until(
        lambda: peer.states[robot].paused and not peer.states[robot].driving, what="the pause"
    )
    say(f"robot {robot} is paused")
    await peer.client.resume(f"kiva/{robot}")
    await peer.until(lambda: peer.states[robot].driving, what="going on")
    await peer.client.cancel_order(f"kiva/{robot}")
    await peer.until(lambda: peer.over(robot, sent.order_id), what="the cancellation")
    at = peer.states[robot].last_node_id
    assert at in {name(cell) for cell in way[2:-1]}, at
    say(f"robot {robot} was cancelled at {at}")


def bad_orders(robot, here):
    """Yields what is wrong with an order, the order, the error's type and a part of its text."""
    column, row = here
    far, beside, across = (column, row + 1000), (column + 1, row), (column + 1, row + 1)
    yield "off the floor", order(robot, [here, far]), "orderError", "off the floor"
    yield "diagonal", order(robot, [here, across]), "orderError", "not in a line"
    elsewhere = order(robot, [(column + 3, row), (column + 4, row)])
    yield "elsewhere", elsewhere, "noRouteError", "not where the robot stands"
    unknown = order(robot, [here, beside])
    unknown.nodes[1].node_id = unknown.edges[0].end_node_id = "gate"
    unknown.nodes[1].node_position = None
    yield "unknown node", unknown, "orderError", "gate"


async def refuses(peer, trip):
    robot = str(trip["robot"])
    column, row = map(int, peer.states[robot].last_node_id[1:].split("_"))
    here = (column, row)
    # dispatch() keeps bad orders back, so they go out behind it.
    send = partial(peer.client._publish_order, VehicleKey("kiva", robot))

    async def told(kind, text, what):
        def errors():
            return [e for e in peer.states[robot].errors if text in (e.error_description or "")]

        await peer.until(errors, what=what)
        say(f"{what}: {errors()[0].error_type}: {errors()[0].error_description}")
        assert errors()[0].error_type == kind, errors()

    for what, bad, kind, text in bad_orders(robot, here):
        await send(bad)
        await told(kind, text, what)
    good = order(robot, [here]).model_copy(update={"order_update_id": 3})
    await send(good)
    await peer.until(lambda: peer.states[robot].order_update_id == 3, what="update 3")
    assert not peer.states[robot].errors, "errors are over with the next order"
    await send(good.model_copy(update={"order_update_id": 2}))
    await told("orderUpdateError", "older", "lower update")


async def moves_all_at_once(peer):
    for turn in (list, lambda way: way[::-1]):
        ways = {robot: turn(way) for robot, way in SITE["steps"].items()}
        await asyncio.gather(*(peer.drive(robot, way) for robot, way in ways.items()))
    say(f"{len(ways)} robots at once, there and back")
    assert len(ways) >= 20


async def main():
    peer = Peer()
    async with peer.client:
        robots = [*SITE["robots"]]
        await peer.until(lambda: len(peer.client.sessions()) >= len(robots), what="vehicles")
        for robot in robots:
            await peer.client.request_state(f"kiva/{robot}")
        await peer.until(lambda: len(peer.states) == len(robots), what="states")
        say(f"{len(robots)} vehicles")
        if "fetch" not in sys.argv:
            await moves_all_at_once(peer)
        await fetches_carries_drops(peer, SITE["trips"][0])
        if "fetch" in sys.argv:
            return
        await extends_without_a_dip(peer, SITE["trips"][0])
        await pauses_and_cancels(peer, SITE["trips"][0])
        await refuses(peer, SITE["trips"][0])
        assert not peer.faults, peer.faults[:3]
    say("done: every message fits the official schemas")


asyncio.run(main())
