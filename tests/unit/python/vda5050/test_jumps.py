# SPDX-License-Identifier: Apache-2.0
"""A vehicle behind a broker that jumps at any moment, with and without a load, among robots of a
fleet at work: whatever becomes of its order, no robot is driven into it, nor it into others.

VDA5050_HISTORIES says how many histories are played. Robots here are drawn on paper: they drive at
once at their full speed, and see nothing.
"""

import math
import os
import random

import numpy as np
import pytest

from kiva_plugin_cpp import World
from warehouse_fleet.hosts.controller import FleetController, Observation
from warehouse_fleet.hosts.random_transports import RandomTransports
from warehouse_fleet.robots.robot_table import NOWHERE, REPORT
from warehouse_fleet.transports.unit_map import UnitPoses
from warehouse_layout.floor import plan_reader
from warehouse_layout.message_enums import RobotMode, State, Status
from warehouse_vda5050 import model
from warehouse_vda5050.errors import Error
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.master.commands import Cancel, Follow, Lift
from warehouse_vda5050.master.remote_vehicle import EventKind, RemoteVehicle
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.master.shadow import shadow_of
from warehouse_vda5050.model import ActionState, ActionStatus, InstantActions
from warehouse_vda5050.topics import Identity

HISTORIES = max(3, int(os.environ.get("VDA5050_HISTORIES", "0")) // 100)
TICK, SPEED, LONG = 0.1, 1.5, 120.0  # [s], [m/s], [s]
JUMPS = 12.0  # between two of them on average [s]
LOAD, CHASSIS = (0.4, 0.4), (0.38, 0.3)  # half lengths and widths [m]
ROOM = 0.65  # around the middle of one that jumps, where none may be on its way [m]


class Robot:
    """One of the fleet: follows paths as the engine does, cell after cell at one speed."""

    def __init__(self, x, y):
        self.x, self.y, self.yaw, self.load = x, y, 0.0, 0
        self.path, self.path_id, self.released, self.reached = [], 0, 0, 1
        self.busy = False

    def follow(self, path_id, first, points, released):
        """Returns whether it refuses."""
        if self.busy and path_id == self.path_id:
            if first <= len(self.path) and released >= self.reached:
                self.path[first:] = points or self.path[first:]
                self.released = released
            return False
        if self.busy or first or path_id == self.path_id or not is_at(self, points[0]):
            return True
        self.path, self.path_id, self.released = [*points], path_id, released
        self.reached, self.busy = 1, True
        return False

    def cancel(self):
        self.released = min(self.released, self.reached + 1)
        del self.path[self.released :]

    def step(self):
        way = SPEED * TICK
        while self.busy and way > 1e-9 and self.reached < self.released:
            way = drive(self, self.path[self.reached], way)
            if not is_at(self, self.path[self.reached]):
                return
            self.reached += 1
        self.busy = self.busy and self.reached < len(self.path)

    def row(self, number):
        waits = self.busy and self.reached >= self.released
        state = State.WAITING if waits else State.MOVING_X if self.busy else State.IDLE
        status = Status.BUSY if self.busy else Status.IDLE
        left = self.reached - 1
        place = (self.x, self.y, self.yaw, SPEED if self.busy and not waits else 0.0, 0.0)
        work = (status, state, self.load, self.path_id, self.reached, left)
        return (number, *place, *work, 0, 1.0, 0)


def drive(body, goal, way):
    """Drives a body some way towards a point; returns what is left of it."""
    dx, dy = goal[0] - body.x, goal[1] - body.y
    far = math.hypot(dx, dy)
    if far < 1e-9:
        return way
    if abs(math.remainder(math.atan2(dy, dx) - body.yaw, math.tau)) > 1e-6:
        body.yaw = math.atan2(dy, dx)
        return 0.0
    part = min(way, far)
    body.x, body.y = body.x + part * dx / far, body.y + part * dy / far
    return way - part


def is_at(body, point):
    return math.dist((body.x, body.y), point) < 1e-6


class Vehicle:
    """A vehicle of another maker, which takes orders to the letter. `turns`: it puts itself
    straight where an order asks for it; else it tells that it is there. It refuses to begin
    elsewhere."""

    def __init__(self, x, y, turns):
        self.x, self.y, self.yaw, self.load = x, y, 0.0, ""
        self.turns, self.jumped = turns, False
        self.order, self.update, self.nodes, self.last = "", 0, [], 0
        self.actions, self.errors = {}, ()
        self.orders = 0

    def take(self, message):
        if isinstance(message, InstantActions):
            for action in message.actions:
                if action.type == "cancelOrder":
                    self.nodes = []
                self.actions[action.id] = ActionState(action.id, action.type, ActionStatus.FINISHED)
            return
        is_new = message.id != self.order
        if (is_new and self.nodes) or (not is_new and message.update <= self.update):
            return
        first = message.nodes[0].position
        if is_new and math.dist((self.x, self.y), (first.x, first.y)) > 0.5:
            refer = (("orderId", message.id), ("orderUpdateId", str(message.update)))
            self.errors = (Error("noRouteError", description="it is elsewhere", references=refer),)
            return
        self.orders += is_new
        self.errors = ()
        self.order, self.update = message.id, message.update
        known = self.last if not is_new else -1
        self.nodes = [node for node in message.nodes if node.sequence > known]
        if is_new:
            self.last, self.jumped = message.nodes[0].sequence, False

    def step(self):
        way = SPEED * TICK
        while self.nodes and self.nodes[0].released and way > 1e-9 and not self.jumped:
            node = self.nodes[0]
            goal = (node.position.x, node.position.y)
            is_first = node.sequence == 0
            if node.demands and self.turns:
                self.x, self.y, self.yaw = *goal, node.position.theta
            elif not is_first:
                way = drive(self, goal, way)
                if not is_at(self, goal):
                    return
            self.pass_node(node)

    def pass_node(self, node):
        self.last = node.sequence
        del self.nodes[0]
        for action in node.actions:
            unit = str(action.parameter("loadId"))
            self.load = unit if action.type == "pick" else ""
            self.actions[action.id] = ActionState(action.id, action.type, ActionStatus.FINISHED)

    def state(self, now):
        states = [model.NodeState(n.id, n.sequence, n.released) for n in self.nodes]
        return model.VehicleState(
            self.order,
            self.update,
            last_node_sequence=self.last,
            nodes=tuple(states),
            actions=tuple(self.actions.values()),
            driving=bool(self.nodes) and not self.jumped,
            position=model.AgvPosition(self.x, self.y, self.yaw),
            loads=(model.Load(self.load),) if self.load else (),
            errors=self.errors,
            header=model.Header(int(now * 1000), f"{now:09.3f}"),
        )


class Floor:
    """A small warehouse at work, robot 1 of it behind a broker."""

    def __init__(self, seed, turns):
        world = World.preset("small")
        self.chance, self.now = random.Random(seed), 0.0
        plan = self.plan = plan_reader.of_world(world)
        x, y = (float(value) for value in plan.point_of(np.int32(0)))
        rows, columns = plan.shape
        fleet, units = world.fleet, world.storage_units
        self.robots = {
            int(k): Robot(float(x), float(y)) for k, x, y in zip(fleet.kiva_id, fleet.x, fleet.y)
        }
        self.stored = {
            int(u): (float(x), float(y))
            for u, x, y in zip(units["shelf_id"], units["x"], units["y"])
        }
        self.controller = FleetController(plan, fleet.kiva_id, seed=seed)
        self.number = 1
        body = self.robots[self.number]
        self.vehicle = Vehicle(body.x, body.y, turns)
        grid = Grid(x, y, plan.spacing, columns, rows)
        self.master = RemoteVehicle(RemoteRobot(1, Identity("acme", "1")), grid, "run")
        self.master.take_connection(model.ConnectionState.ONLINE, 0.0)
        self.refused, self.lost_since, self.events = [], None, []
        self.controller.transports.update_units(self.units())
        self.demand = RandomTransports(self.controller.transports, seed, exchange=3)

    def close(self):
        self.controller.close()

    def units(self):
        ids = sorted(self.stored)
        x, y = np.array([self.stored[u] for u in ids]).T
        held = {robot.load for robot in self.robots.values()} | {self.master.load}
        is_carried = np.array([u in held for u in ids])
        return UnitPoses(np.array(ids), x, y, 0 * x, is_carried, self.now)

    def rows(self):
        rows = [robot.row(n) for n, robot in self.robots.items() if n != self.number]
        shadow = shadow_of(self.master, self.now)
        if shadow:
            fields = {**vars(shadow), "vx": 0.0, "vy": 0.0, "mode": 0}
            rows.append(tuple(fields[name] for name in REPORT.names))
        else:
            rows.append(self.robots[self.number].row(self.number))
        return np.array(sorted(rows), REPORT)

    def step(self):
        self.now += TICK
        control = self.controller
        observation = Observation(
            self.now,
            self.rows(),
            refused=self.refused,
            units=self.units(),
            look_at_units=self.units,
        )
        decision, self.refused = control.tick(observation), []
        self.demand.advance(self.now, control.transports.take_events())
        self.carry_out(decision)
        for message in self.master.messages(self.now):
            self.vehicle.take(message)
        for number, robot in self.robots.items():
            if number != self.number:
                robot.step()
        self.vehicle.step()
        self.master.take_state(self.vehicle.state(self.now), self.now)
        for event in self.master.take_events():
            self.events.append(event)
            if event.kind is EventKind.REFUSED:
                self.refused.append(f"kiva{self.number}")
        self.place_loads()
        self.help()

    def carry_out(self, decision):
        for number, unit, up in decision.lifts:
            if number == self.number:
                self.master.command(Lift(up, unit))
            elif not self.robots[number].busy:
                self.robots[number].load = unit if up else 0
        for number in decision.cancels:
            if number == self.number:
                self.master.command(Cancel())
            else:
                self.robots[number].cancel()
        granted, at = decision.releases, 0
        for number, path, first, count, released in zip(
            granted.kiva_id, granted.path_id, granted.first, granted.points, granted.released
        ):
            points = [
                (float(x), float(y))
                for x, y in zip(granted.x[at : at + count], granted.y[at : at + count])
            ]
            at += count
            if number == self.number:
                self.master.command(Follow(int(path), int(first), tuple(points), int(released)))
            elif self.robots[int(number)].follow(int(path), int(first), points, int(released)):
                self.refused.append(f"kiva{number}")

    def place_loads(self):
        for robot in self.robots.values():
            if robot.load:
                self.stored[robot.load] = (robot.x, robot.y)
        if self.master.load:
            self.stored[self.master.load] = (self.vehicle.x, self.vehicle.y)

    def help(self):
        """A person does what the alarm says; or half of it."""
        robots = self.controller.robots
        if not robots.lost[robots.index(self.number)]:
            self.lost_since = None
            return
        self.lost_since = self.lost_since or self.now
        if self.now - self.lost_since > 2.0:
            if self.chance.random() < 0.5:
                self.vehicle.yaw = 0.0
            self.controller.set_mode(self.number, RobotMode.AUTOMATIC)
            self.lost_since = None

    def jump(self):
        """The vehicle is elsewhere of a sudden, where no other is or is about to be."""
        for _ in range(200):
            x = self.vehicle.x + self.chance.uniform(-2.2, 2.2)
            y = self.vehicle.y + self.chance.uniform(-2.2, 2.2)
            yaw = self.chance.choice([0.0, math.pi / 2, self.chance.uniform(-math.pi, math.pi)])
            if self.is_clear(x, y, yaw):
                self.vehicle.x, self.vehicle.y, self.vehicle.yaw = x, y, yaw
                self.vehicle.jumped = True
                # What was released before it was known is for lasers to see.
                self.master.take_state(self.vehicle.state(self.now + 1e-3), self.now + 1e-3)
                return True
        return False

    def is_clear(self, x, y, yaw):
        plan, robots = self.plan, self.controller.robots
        me = robots.index(self.number)
        for dx in (-ROOM, 0, ROOM):
            for dy in (-ROOM, 0, ROOM):
                cell = int(plan.cell_of(x + dx, y + dy))
                if cell == NOWHERE or not plan.passable.flat[cell]:
                    return False
                if self.controller.traffic.holder(cell) not in (me, NOWHERE):
                    return False
        before = (self.vehicle.x, self.vehicle.y, self.vehicle.yaw)
        self.vehicle.x, self.vehicle.y, self.vehicle.yaw = x, y, yaw
        touched = self.touched()
        self.vehicle.x, self.vehicle.y, self.vehicle.yaw = before
        return not touched

    def touched(self):
        """What the vehicle or its load touches."""
        loaded = bool(self.vehicle.load)
        mine = corners(self.vehicle, LOAD if loaded else CHASSIS)
        touching = []
        for number, robot in self.robots.items():
            if number == self.number:
                continue
            if overlap(mine, corners(robot, LOAD if robot.load else CHASSIS)):
                touching.append(f"kiva{number}")
        if loaded:
            carried = {robot.load for robot in self.robots.values()} | {self.master.load}
            for unit, (x, y) in self.stored.items():
                near = max(abs(x - self.vehicle.x), abs(y - self.vehicle.y)) < 1.2
                if unit not in carried and near and overlap(mine, corners(Robot(x, y), LOAD)):
                    touching.append(f"storage_unit{unit}")
        return touching


def corners(body, half):
    c, s = math.cos(body.yaw), math.sin(body.yaw)
    ends = [(a * half[0], b * half[1]) for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    return [(body.x + c * a - s * b, body.y + s * a + c * b) for a, b in ends]


def overlap(first, other):
    """Whether two rectangles do, by the axes of both."""
    for a, b in [*zip(first, first[1:]), *zip(other, other[1:])]:
        normal = (b[1] - a[1], a[0] - b[0])
        p = [normal[0] * x + normal[1] * y for x, y in first]
        q = [normal[0] * x + normal[1] * y for x, y in other]
        if max(p) <= min(q) + 1e-9 or max(q) <= min(p) + 1e-9:
            return False
    return True


@pytest.mark.parametrize("turns", [True, False])
@pytest.mark.parametrize("seed", range(HISTORIES))
def test_no_robot_is_driven_into_a_vehicle_that_jumps(seed, turns):
    floor = Floor(seed, turns)
    jumps, next_jump = {True: 0, False: 0}, floor.chance.uniform(0.5, JUMPS)
    try:
        while floor.now < LONG:
            floor.step()
            assert not floor.touched(), (floor.now, floor.touched(), floor.events[-5:])
            if floor.now >= next_jump and floor.jump():
                jumps[bool(floor.vehicle.load)] += 1
                next_jump = floor.now + floor.chance.uniform(0.5, 2 * JUMPS)
    finally:
        floor.close()
    texts = [event.text for event in floor.events if event.kind is EventKind.BLOCKED]
    assert sum(jumps.values()) > 3 and texts, floor.events
    assert floor.vehicle.orders < LONG, "it is asked again and again"
