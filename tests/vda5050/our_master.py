#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The coordinator drives vehicles of other makers among simulated robots on one floor: each carries
storage units, without contact; one that is killed is an obstacle with an alarm, and comes back.

Run by scripts/peers/test-vda5050 with a warehouse and its coordinator running.
Argument: the folder of the vehicles' own environments.
"""

import contextlib
import os
import subprocess
import sys
import tempfile
from itertools import cycle
from pathlib import Path

import rospy
from rostest_support.node_test import call, wait_until
from rostest_support.warehouse_test import Collector

from warehouse_client.warehouse import WarehouseClient
from warehouse_layout.floor.stations import PICK
from warehouse_layout.message_enums import FailureKind, Status
from warehouse_msgs.msg import CoordinatorState, Event, FleetState, TransportEvent
from warehouse_msgs.srv import ReleaseTransport, Transport
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.ros.floor import grid_of, read_map

HERE = Path(__file__).resolve().parent
ENVIRONMENTS = Path(sys.argv[1])
ROBOTS = """
21: {manufacturer: lib, serial: "1", action_parameters: {loadType: EPAL, duration: 1}}
22: {manufacturer: sdk, serial: "1"}
"""
COMMANDS = {
    21: ["node", HERE / "lib_vehicle.cjs"],
    22: [ENVIRONMENTS / "sdk" / "bin" / "python", HERE / "sdk_vehicle.py"],
}
NAMES = {21: "VirtualAgvAdapter of vda-5050-lib", 22: "FakeAgv of vda5050-sdk"}
PATIENCE = 240.0  # [s, wall]
RADIO = 1 << FailureKind.RADIO_LOST


def say(text):
    print(f"vehicles: {text}", flush=True)


class Work:
    """Has units brought to picking stations in turn, again and again; a station lets them go as
    soon as they have come."""

    def __init__(self, units, stations):
        self._stations = cycle(stations)
        rospy.Subscriber("/warehouse/transports", TransportEvent, self._on_event)
        for unit in units:
            self._submit(unit)

    def _submit(self, unit):
        station = next(self._stations)
        answer = call("/warehouse/transport", Transport, shelf_id=unit, station=station)
        assert answer.accepted, answer.message

    def _on_event(self, event):
        if event.kind == TransportEvent.ARRIVED:
            call("/warehouse/release_transport", ReleaseTransport, event.transport_id)
        elif event.kind in (TransportEvent.STORED, TransportEvent.FAILED):
            self._submit(event.shelf_id)


class Floor:
    """The warehouse, the processes of the vehicles in it, and what became of them."""

    def __init__(self, port):
        self.port = port
        self.processes = {}
        self.fleet = Collector("/warehouse/fleet", FleetState)
        self.state = Collector("/warehouse/coordinator", CoordinatorState)
        self.events = Collector("/warehouse/events", Event)
        self.transports = Collector("/warehouse/transports", TransportEvent)
        self.warehouse = WarehouseClient(rospy)
        self.state.first(lambda state: state.automatic > 0, PATIENCE)
        wait_until(lambda: self.warehouse.is_known, "the warehouse")
        self.plan = self.warehouse.plan()
        self.grid = grid_of(read_map())

    def free_places(self):
        """Returns parking cells (column, row) on which no robot stands."""
        fleet = self.fleet.messages[-1]
        taken = {int(cell) for cell in self.plan.cell_of(fleet.x, fleet.y)}
        columns = self.plan.shape[1]
        cells = [int(c) for c in self.plan.parking.ravel().nonzero()[0] if int(c) not in taken]
        return [(cell % columns, cell // columns) for cell in cells]

    def start(self, number, cell):
        """Starts the vehicle of a robot: it stands at that cell."""
        x, y = self.grid.position(cell)
        where = [str(value) for value in (self.port, 1, x, y, self.grid.node_id(cell))]
        modules = str(ENVIRONMENTS / "lib" / "node_modules")
        self.processes[number] = subprocess.Popen(
            ["setpriv", "--pdeathsig", "TERM", *COMMANDS[number], *where],
            env={**os.environ, "NODE_PATH": modules, "PYTHONPATH": ""},
        )

    def kill(self, number):
        self.processes[number].kill()
        self.processes[number].wait()

    def close(self):
        for process in self.processes.values():
            process.kill()

    def begin_work(self):
        """Keeps all robots busy from now on."""
        units = sorted(self.warehouse.standing_units(self.plan))
        count = 2 * len(self.fleet.messages[-1].kiva_id)
        stations = [s.name for s in self.plan.stations if s.kind == PICK]
        Work(units[:count], stations)

    def row(self, number):
        """What the fleet tells of a robot last, as {field: value}; {} if it is not there."""
        fleet = self.fleet.messages[-1]
        if number not in fleet.kiva_id:
            return {}
        i = list(fleet.kiva_id).index(number)
        names = ("x", "y", "status", "failures", "shelf_id", "reached")
        return {name: getattr(fleet, name)[i] for name in names}

    def stored(self, number=None):
        """The transports that a robot, or any, has carried out: to a station and back."""
        done = [e for e in self.transports.messages if e.kind == TransportEvent.STORED]
        return [e for e in done if number in (None, e.kiva_id)]

    def fetches(self, number):
        """Whether a robot is on its way to a unit."""
        row = self.row(number)
        return row["status"] == Status.BUSY and not row["shelf_id"] and row["reached"] > 1

    def is_heard(self, number):
        return not self.row(number)["failures"] & RADIO

    def alarm_of(self, number):
        """The coordinator's alarm of a robot; empty without one."""
        alarms = self.state.messages[-1].alarms
        return next((alarm for alarm in alarms if f"kiva{number}" in alarm), "")

    def contacts(self):
        return [e.text for e in self.events.messages if e.kind == Event.COLLISION]


def carry_units(floor):
    simulated = [n for n in floor.fleet.messages[-1].kiva_id if n not in NAMES]
    wait_until(
        lambda: all(map(floor.stored, NAMES)) and any(map(floor.stored, simulated)),
        "each to carry a unit to a station and back",
        PATIENCE,
    )
    for number, name in NAMES.items():
        say(f"kiva{number}, {name}, has carried {len(floor.stored(number))} units")
    done = sum(len(floor.stored(number)) for number in simulated)
    say(f"{len(simulated)} simulated robots have carried {done}")


def comes_back(floor, number):
    """Kills a vehicle on its way to a unit, and starts it again where it stands."""
    wait_until(lambda: floor.fetches(number), f"kiva{number} to fetch a unit", PATIENCE)
    floor.kill(number)
    wait_until(lambda: not floor.is_heard(number), "it is not heard")
    wait_until(lambda: floor.alarm_of(number), "the alarm")
    say(f"killed on its way: {floor.alarm_of(number)}")
    where, steps = floor.row(number), len(floor.transports.messages)
    wait_until(lambda: floor.transports.messages[steps:], "others to work", PATIENCE)
    assert floor.row(number) == where, "an obstacle does not move"
    done = len(floor.stored(number))
    floor.start(number, floor.grid.cell_at(where["x"], where["y"]))
    wait_until(lambda: floor.is_heard(number) and not floor.alarm_of(number), "it is heard")
    wait_until(lambda: len(floor.stored(number)) > done, "it carries a unit again", PATIENCE)
    say(f"kiva{number} is started again, and has carried a unit")


def main():
    rospy.init_node("our_master")
    with contextlib.ExitStack() as stack:
        broker = stack.enter_context(OwnBroker())
        file = Path(stack.enter_context(tempfile.TemporaryDirectory()), "robots.yaml")
        file.write_text(ROBOTS)
        launch = ["roslaunch", "warehouse_vda5050", "master.launch", f"robots:={file}"]
        launch += [f"broker:=localhost:{broker.port}", "version:=2.0.0"]
        master = subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *launch], stdout=sys.stderr)
        stack.callback(master.wait)
        stack.callback(master.terminate)
        arguments = [sys.executable, HERE / "witness.py", str(broker.port), "master"]
        witness = subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *arguments])
        floor = Floor(broker.port)
        stack.callback(floor.close)
        for number, cell in zip(NAMES, floor.free_places()):
            floor.start(number, cell)
        wait_until(lambda: all(map(floor.row, NAMES)), "their shadows")
        floor.begin_work()
        carry_units(floor)
        for number in NAMES:
            comes_back(floor, number)
        assert floor.contacts() == [], floor.contacts()
        witness.terminate()
        assert witness.wait() == 0, "a message of the master does not fit the schemas"
        say(f"no contact, {len(floor.fleet.messages)} states of the fleet")


if __name__ == "__main__":
    main()
