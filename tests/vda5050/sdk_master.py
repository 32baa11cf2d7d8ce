# SPDX-License-Identifier: Apache-2.0
"""PyPI's vda5050-sdk as it comes drives our robots: MasterClient, 2.1.0, checking every message
against the official schemas. Run by scripts/test-vda5050 in the sdk's own environment."""

import asyncio
import json
import sys
import time
from pathlib import Path

from vda5050.client.master import MasterClient
from vda5050.config import MasterConfig
from vda5050.domain.order.builder import OrderBuilder
from vda5050.model.common import Action, ActionParameter
from vda5050.model.enums import BlockingType

PORT = int(sys.argv[1])
SITE = json.loads(Path(sys.argv[2]).read_text())
FLOOR = SITE["floor"]
MAP = "warehouse"


def say(text):
    print(f"sdk: {text}", flush=True)


def action(kind, **parameters):
    told = [ActionParameter(key=k, value=v) for k, v in parameters.items()]
    return Action(
        action_type=kind,
        action_id=f"{kind}-{time.time_ns()}",
        blocking_type=BlockingType.HARD,
        action_parameters=told,
    )


def position(cell):
    x, y = FLOOR["x"] + cell[0] * FLOOR["spacing"], FLOOR["y"] + cell[1] * FLOOR["spacing"]
    return dict(x=x, y=y, map_id=MAP)


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
        self.client.on_error(lambda event: self.faults.append(event))

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
    say(f"robot {robot} brought unit {trip['unit']} to {trip['station']} in "
        f"{time.monotonic() - start:.1f} s")
    await peer.drive(robot, [trip["onward"][-1]], last=action("pick", loadId=trip["unit"]))
    await peer.drive(robot, trip["back"], last=action("drop"))
    say("and back")


async def extends_without_a_dip(peer, trip):
    """Drives the longest straight of a way, a few nodes released at a time."""
    robot, back = str(trip["robot"]), trip["there"][::-1]
    way = longest_straight(trip["there"])
    await peer.drive(robot, back[: back.index(way[0]) + 1])
    ahead = 4
    sent = order(robot, way, released=ahead)
    peer.speeds.clear()
    assert (await peer.client.dispatch(sent, f"kiva/{robot}")).accepted
    released, update = ahead, 0
    while released < len(way):
        index = released

        def near(index=index):
            state = peer.states[robot]
            return state.order_id == sent.order_id and state.last_node_sequence_id // 2 >= index - 3

        await peer.until(near, what="the next node")
        update += 1
        released = min(released + 1, len(way))
        nodes, edges = sent.nodes[index - 1 :], sent.edges[index - 1 :]
        for k, node in enumerate(nodes):
            node.released = index - 1 + k < released
        for k, edge in enumerate(edges):
            edge.released = index + k < released
        message = sent.model_copy(
            update=dict(order_update_id=update, nodes=list(nodes), edges=list(edges))
        )
        await peer.client._publish_order(key_of(robot), message)
    await peer.until(lambda: peer.over(robot, sent.order_id), what="the end")
    speeds = [v for _, serial, v in peer.speeds if serial == robot]
    top = max(speeds)
    first, last = (f(k for k, v in enumerate(speeds) if v > 0.95 * top) for f in (min, max))
    dip = min(speeds[first : last + 1])
    say(f"{len(way)} nodes, released one at a time: top {top:.2f} m/s, least between {dip:.2f} m/s")
    assert dip > 0.9 * top, speeds


def key_of(robot):
    from vda5050.identity import VehicleKey

    return VehicleKey("kiva", robot)


def longest_straight(way):
    runs, run = [], [way[0]]
    for a, b, c in zip([None, *way], way, way[1:]):
        if a is not None and (b[0] - a[0], b[1] - a[1]) != (c[0] - b[0], c[1] - b[1]):
            runs.append(run)
            run = [b]
        run.append(c)
    return max([*runs, run], key=len)


async def cancels_and_pauses(peer, trip):
    robot = str(trip["robot"])
    here = peer.states[robot].last_node_id
    way = trip["there"] if name(trip["there"][0]) == here else trip["there"][::-1]
    while name(way[0]) != here:
        way = way[1:]
    sent = order(robot, way)
    await peer.client._publish_order(key_of(robot), sent)
    await peer.until(lambda: peer.states[robot].driving, what="driving")
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
    assert at != name(way[-1]), "the order was driven to its end"
    say(f"robot {robot} was cancelled at {at}")


async def refuses(peer, trip):
    robot = str(trip["robot"])
    state = peer.states[robot]
    column, row = map(int, state.last_node_id[1:].split("_"))
    here = (column, row)
    bad = {
        "off the floor": ([here, (column, row + 1000)], "off the floor"),
        "diagonal": ([here, (column + 1, row + 1)], "not in a line"),
        "elsewhere": ([(column + 3, row), (column + 4, row)], "not where the robot stands"),
    }
    for what, (cells, text) in bad.items():
        sent = order(robot, cells)
        await peer.client._publish_order(key_of(robot), sent)
        told = lambda text=text: any(text in (e.error_description or "") for e in peer.states[robot].errors)
        await peer.until(told, what=what)
        (error,) = [e for e in peer.states[robot].errors if text in e.error_description]
        say(f"{what}: {error.error_type}: {error.error_description}")
        assert error.error_type in ("orderError", "noRouteError")
    sent = order(robot, [here])
    sent = sent.model_copy(update=dict(order_update_id=3))
    await peer.client._publish_order(key_of(robot), sent)
    await peer.until(lambda: peer.states[robot].order_update_id == 3, what="update 3")
    await peer.client._publish_order(key_of(robot), sent.model_copy(update=dict(order_update_id=2)))
    is_old = lambda: [e for e in peer.states[robot].errors if e.error_type == "orderUpdateError"]
    await peer.until(is_old, what="a lower update")
    say(f"lower update: {is_old()[0].error_description}")


async def all_at_once(peer):
    steps = {}
    for robot in SITE["steps"]:
        column, row = map(int, peer.states[robot].last_node_id[1:].split("_"))
        steps[robot] = SITE["steps"][robot]
        assert [column, row] == list(steps[robot][0]) or len(steps) < 4, robot
    still = {r: s for r, s in steps.items() if peer.states[r].last_node_id == name(s[0])}
    for _ in range(2):
        await asyncio.gather(*(peer.drive(robot, way) for robot, way in still.items()))
        still = {robot: way[::-1] for robot, way in still.items()}
    say(f"{len(still)} robots at once, there and back")
    assert len(still) >= 15


async def main():
    peer = Peer()
    async with peer.client:
        robots = [*SITE["robots"]]
        await peer.until(lambda: len(peer.client.sessions()) >= len(robots), what="vehicles")
        for robot in robots:
            await peer.client.request_state(f"kiva/{robot}")
        await peer.until(lambda: len(peer.states) == len(robots), what="states")
        say(f"{len(robots)} vehicles")
        await all_at_once(peer)
        await fetches_carries_drops(peer, SITE["trips"][0])
        await extends_without_a_dip(peer, SITE["trips"][0])
        await cancels_and_pauses(peer, SITE["trips"][0])
        await refuses(peer, SITE["trips"][0])
        assert not peer.faults, peer.faults[:3]
    say("done: every message fits the official schemas")


asyncio.run(main())
