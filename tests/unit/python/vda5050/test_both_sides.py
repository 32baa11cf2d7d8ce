# SPDX-License-Identifier: Apache-2.0
"""Master and vehicle over a line that loses, doubles and swaps messages: transports are carried out
once and whole, whatever becomes of messages. HISTORIES: how many random ones are tried."""

import os
import random

import pytest
from grid_robot import GRID, Bench

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.master.commands import Cancel, Follow, Lift
from warehouse_vda5050.master.remote_vehicle import RemoteVehicle
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.model import ConnectionState, Order
from warehouse_vda5050.topics import Identity, Kind

HISTORIES = int(os.environ.get("HISTORIES", "40"))
WHO = Identity("kiva", "1")
PATIENCE = 900  # [s] for one command


class Line:
    """Both sides, a second a step. `faults`: how likely a message is lost, doubled or swapped."""

    def __init__(self, seed, faults):
        self.random, self.faults = random.Random(seed), faults
        self.vehicle = Bench((0, 0), {"storage_unit7": (3, 2)})
        self.master = RemoteVehicle(RemoteRobot(1, WHO), GRID, f"run{seed}")
        self.master.take_connection(ConnectionState.ONLINE, 0.0)
        self.codec, self.clock = codec_for(), 0.0
        self.sides = [Headers(WHO, "2.1.0", lambda: self.clock) for _ in range(2)]
        self.down, self.up = [], []  # on their way
        self.events = []

    def step(self):
        self.clock += 1.0
        for message in self.master.messages(self.clock):
            kind = Kind.ORDER if isinstance(message, Order) else Kind.INSTANT_ACTIONS
            self._post(self.down, 0, kind, message)
        for kind, payload in self._arrived(self.down):
            self._to_vehicle(kind, self.codec.decode(kind, payload).message)
        before = len(self.vehicle.states)
        self.vehicle.tick()
        for state in self.vehicle.states[before:]:
            self._post(self.up, 1, Kind.STATE, state)
        for kind, payload in self._arrived(self.up):
            self.master.take_state(self.codec.decode(kind, payload).message, self.clock)
        self.events += [(e.kind.value, e.text) for e in self.master.take_events()]

    def _to_vehicle(self, kind, message):
        vehicle, now = self.vehicle.vehicle, self.vehicle.now
        if kind is Kind.ORDER:
            vehicle.on_order(message, now)
        else:
            vehicle.on_instant_actions(message, now)

    def _post(self, line, side, kind, message):
        header = self.sides[side].next(kind)
        payload = self.codec.encode(type(message)(**{**vars(message), "header": header}))
        fate = self.random.random() / self.faults if self.faults else 9
        if fate < 0.5:
            return
        line += [(kind, payload)] * (2 if fate < 0.75 else 1)
        if fate < 1 and len(line) > 1:
            line[-1], line[-2] = line[-2], line[-1]

    def _arrived(self, line):
        """Most of what is on its way; the rest comes later."""
        count = len(line) if self.random.random() > self.faults else self.random.randint(0, len(line))
        arrived = line[:count]
        del line[:count]
        return arrived

    def command(self, command):
        """Gives a command until it is accepted and over; returns the last event."""
        begin = len(self.events)
        self.master.command(command)
        for _ in range(PATIENCE):
            self.step()
            ends = [e for e in self.events[begin:] if e[0] in ("DONE", "BLOCKED", "REFUSED")]
            if ends and self.master.is_idle:
                return ends[-1]
        raise AssertionError(f"{command} never ended: {self.events[begin:]}")


def way(start, goal):
    """Points from one cell to another, along x first."""
    cells = [start]
    while cells[-1] != goal:
        x, y = cells[-1]
        step = (1 if goal[0] > x else -1, 0) if x != goal[0] else (0, 1 if goal[1] > y else -1)
        cells.append((x + step[0], y + step[1]))
    return tuple((float(x), float(y)) for x, y in cells)


def drive(line, path_id, goal):
    """Drives there, released in random portions, as often as it takes."""
    for attempt in range(20):
        points = way(line.vehicle.robot.cell, goal)
        released = line.random.randint(1, len(points))
        line.master.command(Follow(path_id + 100 * attempt, 0, points, released))
        for _ in range(PATIENCE):
            line.step()
            if line.master.is_idle:
                break
            if line.random.random() < 0.5 and released < len(points):
                released += 1
                line.master.command(Follow(path_id + 100 * attempt, 0, (), released))
        if line.vehicle.robot.cell == goal and line.master.is_idle:
            return
    raise AssertionError(f"never came to {goal}: {line.events[-10:]}")


def lift(line, up):
    """Lifts until the unit is up or down, as a coordinator would."""
    for _ in range(20):
        line.command(Lift(up, 7))
        if bool(line.vehicle.robot.load) == up and line.master.is_idle:
            return
    raise AssertionError(f"never lifted: {line.events[-10:]}")


@pytest.mark.parametrize("faults", [0.0, 0.2, 0.4])
def test_a_unit_is_fetched_and_put_down_once(faults):
    for seed in range(HISTORIES):
        line = Line(seed, faults)
        line.step()
        while not line.master.view.is_there:
            line.step()
        drive(line, 1, (3, 2))
        lift(line, up=True)
        drive(line, 2, (8, 4))
        lift(line, up=False)
        handled = [e for e in line.vehicle.robot.events if e[0] != "at"]
        assert handled == [("pick", "storage_unit7", (3, 2)), ("drop", "storage_unit7", (8, 4))], seed


def test_a_path_is_cancelled_at_a_grid_point():
    for seed in range(HISTORIES):
        line = Line(seed, 0.2)
        while not line.master.view.is_there:
            line.step()
        line.master.command(Follow(5, 0, way((0, 0), (9, 0)), 10))
        for _ in range(line.random.randint(2, 12)):
            line.step()
        kind, _ = line.command(Cancel()) if not line.master.is_idle else ("DONE", "")
        assert kind in ("DONE", "REFUSED"), line.events
        assert not line.vehicle.vehicle.state().nodes
