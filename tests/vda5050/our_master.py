#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The coordinator drives vehicles of other makers among simulated robots on one floor: each carries
storage units, without contact; one that is killed is an obstacle with an alarm, and comes back.

Run by scripts/test-vda5050 with a warehouse, its coordinator and random transports running.
Argument: the folder of the vehicles' own environments.
"""

import contextlib
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import rospy

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "rostest"))

from node_test import wait_until
from warehouse_test import Collector

from warehouse_client.warehouse import Warehouse
from warehouse_fleet.message_enums import FailureKind, Status
from warehouse_msgs.msg import CoordinatorState, Event, FleetState, TransportEvent
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.ros.master import grid_of

ENVIRONMENTS = Path(sys.argv[1])
ROBOTS = """
21: {manufacturer: lib, serial: "1", action_parameters: {loadType: EPAL, duration: 2}}
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


class Floor:
    """The warehouse, the processes of the vehicles in it, and what became of them."""

    def __init__(self, port):
        self.port = port
        self.processes = {}
        self.fleet = Collector("/warehouse/fleet", FleetState)
        self.state = Collector("/warehouse/coordinator", CoordinatorState)
        self.events = Collector("/warehouse/events", Event)
        self.transports = Collector("/warehouse/transports", TransportEvent)
        warehouse = Warehouse(rospy)
        self.state.first(lambda state: state.automatic > 0, PATIENCE)
        wait_until(lambda: warehouse.is_known, "the warehouse")
        self.plan = warehouse.plan()
        self.grid = grid_of(self.plan)

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
        path = os.pathsep.join([str(ENVIRONMENTS / "lib" / "node_modules")])
        self.processes[number] = subprocess.Popen(
            ["setpriv", "--pdeathsig", "TERM", *COMMANDS[number], *where],
            env={**os.environ, "NODE_PATH": path, "PYTHONPATH": ""},
        )

    def kill(self, number):
        self.processes[number].kill()
        self.processes[number].wait()

    def close(self):
        for process in self.processes.values():
            process.kill()

    def row(self, number):
        """What the fleet tells of a robot last, as {field: value}; {} if it is not there."""
        fleet = self.fleet.messages[-1]
        if number not in fleet.kiva_id:
            return {}
        i = list(fleet.kiva_id).index(number)
        names = ("x", "y", "status", "failures", "shelf_id", "reached")
        return {name: getattr(fleet, name)[i] for name in names}

    def stored(self, number):
        """How many transports a robot has carried out: to a station and back."""
        done = [e for e in self.transports.messages if e.kind == TransportEvent.STORED]
        return sum(e.kiva_id == number for e in done)

    def is_heard(self, number):
        return not self.row(number)["failures"] & RADIO

    def has_alarm(self, number):
        return any(f"kiva{number}" in alarm for alarm in self.state.messages[-1].alarms)

    def contacts(self):
        return [e.text for e in self.events.messages if e.kind == Event.COLLISION]


def carries_units(floor):
    simulated = [n for n in floor.fleet.messages[-1].kiva_id if n not in NAMES]
    wait_until(
        lambda: all(map(floor.stored, NAMES)) and any(map(floor.stored, simulated)),
        "each to carry a unit to a station and back",
        PATIENCE,
    )
    for number, name in NAMES.items():
        say(f"kiva{number}, {name}, has carried {floor.stored(number)} units")
    say(f"{len(simulated)} simulated robots have carried {sum(map(floor.stored, simulated))}")


def comes_back(floor, number):
    """Kills a vehicle on its way to a unit, and starts it where it stands."""

    def drives():
        row = floor.row(number)
        return row["status"] == Status.BUSY and not row["shelf_id"] and row["reached"] > 1

    wait_until(drives, f"kiva{number} to drive", PATIENCE)
    floor.kill(number)
    wait_until(lambda: not floor.is_heard(number), "it is not heard")
    wait_until(lambda: floor.has_alarm(number), "the alarm")
    (alarm,) = [a for a in floor.state.messages[-1].alarms if f"kiva{number}" in a]
    say(f"kiva{number} is killed on its way: {alarm}")
    where = floor.row(number)
    before = sum(e.kind == TransportEvent.STORED for e in floor.transports.messages)
    wait_until(
        lambda: sum(e.kind == TransportEvent.STORED for e in floor.transports.messages) > before,
        "others to go on",
        PATIENCE,
    )
    assert floor.row(number) == where, "an obstacle does not move"
    done = floor.stored(number)
    floor.start(number, floor.grid.cell_at(where["x"], where["y"]))
    wait_until(lambda: floor.is_heard(number) and not floor.has_alarm(number), "it is heard")
    wait_until(lambda: floor.stored(number) > done, "it carries a unit again", PATIENCE)
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
        floor = Floor(broker.port)
        stack.callback(floor.close)
        for number, cell in zip(NAMES, floor.free_places()):
            floor.start(number, cell)
        wait_until(lambda: all(map(floor.row, NAMES)), "their shadows")
        carries_units(floor)
        for number in NAMES:
            comes_back(floor, number)
        assert floor.contacts() == [], floor.contacts()
        say(f"no contact, {len(floor.fleet.messages)} states of the fleet")


if __name__ == "__main__":
    main()
