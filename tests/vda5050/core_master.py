# SPDX-License-Identifier: Apache-2.0
"""PyPI's vda5050-core as it comes drives our robots: VDA5050Master, 2.0.0, C++, which drops states
that are malformed. Run by scripts/peers/test-vda5050 in its own environment.

Arguments: the broker's port, the file that floor.py wrote."""

import json
import sys
import time
from pathlib import Path

from vda5050_core import types
from vda5050_core.master import OrderAssignmentDecision, VDA5050Master
from vda5050_core.transport import create_default_client_shared

PORT = int(sys.argv[1])
SITE = json.loads(Path(sys.argv[2]).read_text())
FLOOR = SITE["floor"]
AHEAD = 4  # nodes released ahead of a robot that drives
# The library sends an update only if the robot is so near to its first node [m], which is ahead.
NEAR = 50.0
SENT = (OrderAssignmentDecision.ASSIGNED, OrderAssignmentDecision.STITCH_QUEUED)
OVER = (types.ActionStatus.FINISHED, types.ActionStatus.FAILED)


def say(text):
    print(f"core: {text}", flush=True)


def until(condition, what, seconds=90.0):
    end = time.monotonic() + seconds
    while not (value := condition()):
        assert time.monotonic() < end, f"{what} in vain"
        time.sleep(0.02)
    return value


def name(cell):
    return f"c{cell[0]}_{cell[1]}"


def header(robot):
    stamp = time.strftime("%Y-%m-%dT%H:%M:%S.000Z", time.gmtime())
    fields = {"headerId": 0, "timestamp": stamp, "version": "2.0.0"}
    return {**fields, "manufacturer": "kiva", "serialNumber": robot}


def action(kind, **parameters):
    """Returns an action; the library has texts alone as values."""
    listed = [{"key": key, "value": str(value)} for key, value in parameters.items()]
    named = {"actionType": kind, "actionId": f"{kind}-{time.time_ns()}"}
    return {**named, "blockingType": "HARD", "actionParameters": listed}


def node(cell, k, released, actions):
    x, y = FLOOR["x"] + cell[0] * FLOOR["spacing"], FLOOR["y"] + cell[1] * FLOOR["spacing"]
    place = {"x": x, "y": y, "mapId": "warehouse", "allowedDeviationXY": NEAR}
    fields = {"nodeId": name(cell), "sequenceId": 2 * k, "released": released}
    return {**fields, "nodePosition": place, "actions": actions}


def edge(a, b, k, released):
    fields = {"edgeId": f"{name(a)}-{name(b)}-{k}", "sequenceId": 2 * k + 1, "released": released}
    return {**fields, "startNodeId": name(a), "endNodeId": name(b), "actions": []}


def order(robot, cells, last=None, order_id=None, update=0, first=0, released=None):
    """Returns an order through cells as JSON, from cell number `first` on; `last` is the action at
    the last of them, `released` the number of cells that are."""
    released = len(cells) if released is None else released
    at_end = [last] if last else []
    nodes = [
        node(cell, k, k < released, at_end if k == len(cells) - 1 else [])
        for k, cell in enumerate(cells)
    ]
    edges = [edge(a, b, k, k + 1 < released) for k, (a, b) in enumerate(zip(cells, cells[1:]))]
    named = {"orderId": order_id or f"order-{time.time_ns()}", "orderUpdateId": update}
    return {**header(robot), **named, "nodes": nodes[first:], "edges": edges[first:]}


class Peer:
    """The VDA5050Master, and what it was told."""

    def __init__(self):
        client = create_default_client_shared(f"tcp://localhost:{PORT}", "vda5050-core")
        self.master = VDA5050Master.make(client)
        self.states, self.completed, self.speeds = {}, set(), []
        self.master.on_state(self._on_state)
        self.master.on_order_complete(lambda _, order_id: self.completed.add(order_id))
        self.master.connect()
        for robot in SITE["robots"]:
            self.master.onboard_agv("kiva", robot)

    def _on_state(self, vehicle, state):
        robot = vehicle.split("/")[1]
        self.states[robot] = state
        if state.velocity and state.velocity.vx is not None:
            self.speeds.append((robot, abs(state.velocity.vx)))

    def send(self, robot, message):
        """Sends an order that the library finds in order."""
        result = self.master.assign_order("kiva", robot, types.Order.from_json(message))
        assert result.decision in SENT, [result.decision, [e.json() for e in result.errors]]

    def slip(self, robot, message):
        """Sends an order past what the library checks beforehand."""
        assert self.master.publish_order("kiva", robot, types.Order.from_json(message))

    def is_over(self, robot, order_id):
        state = self.states[robot]
        ended = all(action.action_status in OVER for action in state.action_states)
        return state.order_id == order_id and not state.node_states and ended

    def await_end(self, robot, order_id):
        until(lambda: order_id in self.completed, f"the end of {order_id} of robot {robot}")
        states = self.states[robot].action_states
        assert types.ActionStatus.FAILED not in [a.action_status for a in states], robot

    def drive(self, robot, cells, last=None):
        message = order(robot, cells, last)
        self.send(robot, message)
        self.await_end(robot, message["orderId"])

    def instantly(self, robot, kind):
        fields = {**action(kind), "blockingType": "NONE"}
        message = types.InstantActions.from_json({**header(robot), "actions": [fields]})
        result = self.master.assign_instant_actions("kiva", robot, message)
        assert result, [result.decision, [e.json() for e in result.errors]]


def moves_all_at_once(peer):
    for turn in (list, lambda way: way[::-1]):
        orders = {robot: order(robot, turn(way)) for robot, way in SITE["steps"].items()}
        for robot, message in orders.items():
            peer.send(robot, message)
        for robot, message in orders.items():
            peer.await_end(robot, message["orderId"])
    say(f"{len(orders)} robots at once, there and back")
    assert len(orders) >= 20


def fetches_carries_drops(peer, trip):
    robot, unit = str(trip["robot"]), str(trip["unit"])
    peer.drive(robot, trip["there"], action("pick", loadId=unit))
    assert [load.load_id for load in peer.states[robot].loads] == [unit]
    peer.drive(robot, trip["onward"], action("drop", loadId=unit))
    assert not peer.states[robot].loads
    say(f"robot {robot} brought unit {unit} to {trip['station']}")
    peer.drive(robot, [trip["onward"][-1]], action("pick", loadId=unit))
    peer.drive(robot, trip["back"], action("drop"))
    say("and back")


def extends_without_a_dip(peer, trip):
    """Drives a straight whose nodes are released one at a time, while it drives."""
    robot, way = str(trip["robot"]), trip["straight"]
    peer.drive(robot, trip["approach"])
    name, update = f"order-{time.time_ns()}", 0
    peer.speeds.clear()
    peer.send(robot, order(robot, way, order_id=name, released=AHEAD))

    def passed():
        state = peer.states[robot]
        return state.last_node_sequence_id // 2 if state.order_id == name else 0

    for k in range(AHEAD, len(way)):
        until(lambda k=k: passed() > k - AHEAD, "a node")
        assert peer.states[robot].driving, "it stands, and the next node comes only now"
        update += 1
        extension = order(robot, way, order_id=name, update=update, first=k - 1, released=k + 1)
        peer.send(robot, extension)
    peer.await_end(robot, name)
    speeds = [speed for serial, speed in peer.speeds if serial == robot]
    top = max(speeds)
    fast = [k for k, speed in enumerate(speeds) if speed > 0.99 * top]
    dip = min(speeds[fast[0] : fast[-1] + 1])
    say(f"{len(way)} nodes, {update} updates while it drove: {dip:.2f} to {top:.2f} m/s")
    assert dip > 0.97 * top and fast[-1] - fast[0] > 10, speeds


def pauses_and_cancels(peer, trip):
    robot, way = str(trip["robot"]), trip["straight"][::-1]
    expected = order(robot, way)
    peer.send(robot, expected)
    until(lambda: peer.states[robot].last_node_id == name(way[2]), "the third node")
    peer.instantly(robot, "startPause")
    until(lambda: peer.states[robot].paused and not peer.states[robot].driving, "the pause")
    say(f"robot {robot} is paused")
    peer.instantly(robot, "stopPause")
    until(lambda: peer.states[robot].driving, "going on")
    peer.instantly(robot, "cancelOrder")
    until(lambda: peer.is_over(robot, expected["orderId"]), "the cancellation")
    at = peer.states[robot].last_node_id
    assert at in {name(cell) for cell in way[2:-1]}, at
    say(f"robot {robot} was cancelled at {at}")


def bad_orders(robot, here):
    """Returns {what is wrong: (an order, the error's type, a part of its text)}."""
    column, row = here
    far, beside, across = (column, row + 1000), (column + 1, row), (column + 1, row + 1)
    unknown = order(robot, [here, beside])
    unknown["nodes"][1]["nodeId"] = unknown["edges"][0]["endNodeId"] = "gate"
    del unknown["nodes"][1]["nodePosition"]
    elsewhere = order(robot, [(column + 3, row), (column + 4, row)])
    return {
        "off the floor": (order(robot, [here, far]), "orderError", "off the floor"),
        "diagonal": (order(robot, [here, across]), "orderError", "not in a line"),
        "unknown node": (unknown, "orderError", "gate"),
        "elsewhere": (elsewhere, "noRouteError", "not where the robot stands"),
    }


def refuses(peer, robots):
    """Each robot gets one bad order: the library takes it for under way, refused or not. Lower
    updates it sends to none."""
    for k, robot in enumerate(robots):
        here = tuple(map(int, peer.states[robot].last_node_id[1:].split("_")))
        what, (bad, kind, text) = [*bad_orders(robot, here).items()][k]
        peer.slip(robot, bad)
        error = until(lambda: peer.states[robot].errors, what)[0]  # noqa: B023
        say(f"{what}: {error.error_type}: {error.error_description}")
        assert error.error_type == kind and text in error.error_description, error.json()


def main():
    peer = Peer()
    robots = [*SITE["robots"]]
    agvs = {robot: peer.master.get_agv("kiva", robot) for robot in robots}
    until(lambda: all(agv.is_connected() for agv in agvs.values()), "vehicles")
    for robot in robots:
        peer.instantly(robot, "stateRequest")
    until(lambda: len(peer.states) == len(robots), "states")
    until(lambda: all(agv.get_last_factsheet() for agv in agvs.values()), "factsheets")
    say(f"{len(robots)} vehicles")
    trip = SITE["trips"][2]
    moves_all_at_once(peer)
    fetches_carries_drops(peer, trip)
    extends_without_a_dip(peer, trip)
    pauses_and_cancels(peer, trip)
    refuses(peer, [robot for robot in robots if robot != str(trip["robot"])][:4])
    peer.master.disconnect()
    say("done")


main()
