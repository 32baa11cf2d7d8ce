# SPDX-License-Identifier: Apache-2.0
"""What goes wrong in a warehouse, by chance: messages are late or lost, robots stop for a while."""

from types import SimpleNamespace

import numpy as np

from warehouse_fleet.robots.robot_table import REPORT

DELIVERY = 0.02  # between two looks whether messages have arrived [s]


class Line:
    """Messages in one direction: of all, the part `late` by up to `delay` seconds, the part `lost`.
    They may overtake each other."""

    def __init__(self, random, late, delay, lost):
        self._random, self._late, self._delay, self._lost = random, late, delay, lost
        self._under_way = []  # (arrival, number, message)
        self._sent = 0

    def send(self, time, message):
        if self._random.random() < self._lost:
            return
        late = self._random.random() < self._late
        arrival = time + (self._random.uniform(0, self._delay) if late else 0)
        self._sent += 1
        self._under_way.append((arrival, self._sent, message))

    def arrived(self, time):
        """Carries the messages out in the order of arrival."""
        come = sorted(m[:2] + (m,) for m in self._under_way if m[0] <= time + 1e-9)
        self._under_way = [m for m in self._under_way if m[0] > time + 1e-9]
        return [m[2] for _, _, m in come]


class BadConnection:
    """A World whose reports and commands travel over bad Lines; the rest of it as it is."""

    def __init__(self, world, seed=1, late=0.5, delay=0.2, lost=0.1):
        random = np.random.default_rng(seed)
        self._world = world
        self._reports = Line(random, late, delay, lost)
        self._commands = Line(random, late, delay, lost)
        self._chunk = round(DELIVERY / world.step_size)
        self.time, self.fleet = self._report()

    def __getattr__(self, name):
        return getattr(self._world, name)

    def _report(self):
        fleet = self._world.fleet
        report = {name: np.array(getattr(fleet, name)) for name in REPORT.names if name != "mode"}
        return self._world.time, SimpleNamespace(**report)

    def _command(self, name, *args):
        self._commands.send(self._world.time, (name, args))

    def follow(self, kiva_id, path_id, first, points, x, y, released):
        begin = 0
        for robot, count in enumerate(np.asarray(points).tolist()):
            own = slice(begin, begin + count)
            row = [np.asarray(column)[robot : robot + 1] for column in (kiva_id, path_id, first)]
            self._command(
                "follow",
                *row,
                points[robot : robot + 1],
                x[own],
                y[own],
                released[robot : robot + 1],
            )
            begin += count

    def carry(self, kiva_id, shelf_id):
        self._command("carry", kiva_id, shelf_id)

    def drop(self, kiva_id, shelf_id):
        self._command("drop", kiva_id, shelf_id)

    def step(self, steps):
        while steps > 0:
            for name, args in self._commands.arrived(self._world.time):
                getattr(self._world, name)(*args)
            chunk = min(steps, self._chunk)
            self._world.step(chunk)
            steps -= chunk
        self._reports.send(self._world.time, self._report())
        for report in self._reports.arrived(self._world.time):
            self.time, self.fleet = report


class Stops:
    """Some of the robots stop, one after the other, for 1 to 20 s."""

    def __init__(self, world, seed=1, every=2.0):
        self._world, self._random, self._every = world, np.random.default_rng(seed), every
        self._until = {}  # by robot [s]
        self._next = world.time

    def advance(self):
        time = self._world.time
        for robot in [r for r, until in self._until.items() if until <= time]:
            del self._until[robot]
            self._world.stop(robot, False)
        if time >= self._next:
            self._next = time + self._every
            robot = int(self._random.choice(self._world.fleet.kiva_id))
            if robot not in self._until:
                self._until[robot] = time + self._random.uniform(1, 20)
                self._world.stop(robot, True)

    def end(self):
        for robot in self._until:
            self._world.stop(robot, False)
        self._until.clear()
