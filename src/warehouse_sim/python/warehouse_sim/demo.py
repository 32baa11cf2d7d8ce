# SPDX-License-Identifier: Apache-2.0
"""The demonstration: two robots fetch two storage units at once, then meet head on; at last a fleet
delivers.

The robots are commanded by the actions /warehouse/move and /warehouse/carry. What is expected is
checked against the events and the poses of the world.
"""

import math
import subprocess
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from actionlib import ActionClient, CommState

from warehouse_client import tracking
from warehouse_client.coordinator import CoordinatorClient
from warehouse_client.message_check import subscribe
from warehouse_client.routes import Point, goals, route
from warehouse_client.services import is_offered
from warehouse_client.warehouse import WarehouseClient
from warehouse_msgs.msg import (
    CarryAction,
    CarryGoal,
    Event,
    FleetState,
    MoveAction,
    MoveGoal,
    TransportEvent,
)
from warehouse_msgs.srv import CreateWarehouse
from warehouse_sim import event_text
from warehouse_sim.errands import Chart, Errand, meeting, two_errands

TOLERANCE = 0.05  # largest distance from an expected place [m]
PATIENCE = 60.0  # with a warehouse being built [s, wall]
DELAY = 10.0  # longest time between a robot's end of work and the messages about it [s, wall]
PERIOD = 0.02  # between two looks at incoming messages [s, wall]
ON_UNIT = 0.6  # an item is no further from its unit's centre [m]
FLEET = "medium"  # the warehouse that a coordinator drives
EXCHANGE = 20  # from one unit to the next at a station [s]
DEADLINE = 10.0  # longest duration of a simulated second [s, wall]

SILENT = (Event.ACCEPTED, Event.SPAWNED, Event.DELETED)
COLUMNS = {
    "commands": (Event.ACCEPTED,),
    "lifts": (Event.LIFTED, Event.DROPPED),
    "blocked": (Event.BLOCKED,),
    "refused": (Event.REFUSED,),
    "collisions": (Event.COLLISION,),
}


class DemoError(RuntimeError):
    """Raised where an expectation fails; names it."""


class Demo:
    """The acts. `ros` is rospy; `write(text)` reaches the person who watches.

    `deadline` [s, wall] bounds each scene.
    """

    def __init__(self, ros: Any, write: Callable[[str], object], deadline: float) -> None:
        self._ros, self._write, self._deadline = ros, write, deadline
        self._metres: Counter[int] = Counter()
        self._turns: Counter[int] = Counter()  # [quarter turns]
        self._events: list[Event] = []
        self._cast: list[int] = []
        self.failed: list[str] = []
        self._world = WarehouseClient(ros, self._measure)
        self._clients = {
            MoveGoal: ActionClient("warehouse/move", MoveAction),
            CarryGoal: ActionClient("warehouse/carry", CarryAction),
        }
        self._answers = subscribe(ros, "warehouse/events", Event, self._on_event, queue_size=1000)

    def play(self) -> None:
        """Plays the acts of two robots. Raises NoRouteError or DemoError if they can't go on."""
        self._look()
        belts = {s.belt: self._cell(s.service_cell) for s in self._plan.stations if s.belt}
        errands = two_errands(self._chart(), belts)
        self._cast = [errand.robot for errand in errands]
        self._fetch(errands)
        self._meet(self._line_up())
        for kind, name in ((Event.REFUSED, "refused"), (Event.COLLISION, "a collision")):
            self._judge(f"nothing was {name}", not self._models(kind))

    def deliver(self, duration: float) -> None:
        """Plays the last act: a fleet delivers for a duration [s, simulated]. Raises DemoError."""
        self._write(f"\nThe robots of a {FLEET} warehouse bring storage units to the stations.\n")
        if is_offered(self._ros, "warehouse/transport"):
            raise DemoError("a coordinator runs already; the demonstration brings its own")
        fleet = CoordinatorClient(self._ros)
        self._build(FLEET)
        before = len(self._events)
        with coordinator():
            self._until(lambda: fleet.state and fleet.state.automatic, PATIENCE)
            state = fleet.state
            if not (state and state.automatic):
                alarms = state.alarms if state else ()
                raise DemoError("; ".join(alarms) or "no coordinator publishes its robots' states")
            end = fleet.time + duration
            is_over = self._until(lambda: fleet.time >= end, PATIENCE + DEADLINE * duration)
        state = fleet.state
        count = sum(event.kind == TransportEvent.ARRIVED for event in fleet.take_events())
        kinds = {event.kind for event in self._events[before:]}
        self._judge(f"{state.automatic} robots were coordinated for {duration:g} s", is_over)
        self._judge(f"{count} storage units were delivered", count > 0)
        self._judge("there was no collision", Event.COLLISION not in kinds)
        self._judge("every robot moved on", not state.watchdog)

    def table(self) -> str:
        """Returns a line of text for each robot of the first acts."""
        titles = ["robot", "metres", "quarter turns", *COLUMNS]
        widths = [max(len(title), 6) for title in titles]
        rows = [titles, ["-" * width for width in widths], *map(self._row, self._cast)]
        return "\n".join("  ".join(f"{c:>{w}}" for c, w in zip(row, widths)) for row in rows)

    def _row(self, robot: int) -> list[str]:
        name = f"kiva{robot}"
        # A collision involves the other body, too.
        kinds = [
            e.kind for e in self._events if name in (e.model, e.kind == Event.COLLISION and e.other)
        ]
        counts = [str(sum(kind in column for kind in kinds)) for column in COLUMNS.values()]
        return [name, f"{self._metres[robot]:.1f}", f"{self._turns[robot]:.0f}", *counts]

    # --- the acts

    def _fetch(self, errands: Sequence[Errand]) -> None:
        self._write("\nEach robot brings a storage unit to a conveyor belt, both at once.\n")
        self._act(*(CarryGoal(e.robot, e.unit, *self._point(e.to_belt[-1])) for e in errands))
        # Out beneath the unit, by the way it came in.
        self._act(*(MoveGoal(e.robot, *self._point(e.exit)) for e in errands))
        for errand in errands:
            self._check_delivered(errand)

    def _line_up(self) -> dict[int, Point]:
        """Brings both robots to the ends of an aisle; returns where each goes then."""
        self._write("\nThey line up at the two ends of an aisle.\n")
        chart, (a, b) = self._chart(), self._cast
        aisles = chart.free() | {chart.robots[a], chart.robots[b]}
        ends = meeting(aisles - set(chart.units.values()), chart.robots[a], chart.robots[b])
        for robot, end in zip(self._cast, ends):
            self._drive(robot, end)
        return {a: ends[1], b: ends[0]}

    def _meet(self, ends: dict[int, Point]) -> None:
        self._write("\nEach sets off for the other's place. A blocked robot finds another way.\n")
        moves = (MoveGoal(robot, *self._point(cell)) for robot, cell in ends.items())
        self._act(*moves, may_be_blocked=True)
        self._expect("meeting head on, one of them was blocked at least", self._is_blocked)
        # A robot that was blocked at once still stands at the other's goal.
        taken = set(self._chart().robots.values())
        for robot, cell in sorted(ends.items(), key=lambda pair: pair[1] in taken):
            self._drive(robot, cell)
            x, y = self._point(cell)
            text = f"kiva{robot} reached ({x:g}, {y:g}) all the same"
            self._expect(text, self._is_at, robot, cell)

    def _drive(self, robot: int, goal: Point) -> None:
        chart = self._chart()
        for cell in goals(route(chart.free(without=robot), chart.robots[robot], goal)):
            self._act(MoveGoal(robot, *self._point(cell)))

    def _act(self, *goals: Any, may_be_blocked: bool = False) -> None:
        """Sends a goal to each of some robots and waits for their ends. Raises DemoError."""
        handles = {}
        for goal in goals:
            self._write(self._line_of(goal))
            handles[f"kiva{goal.kiva_id}"] = self._clients[type(goal)].send_goal(goal)
        is_over = [lambda h=h: h.get_comm_state() == CommState.DONE for h in handles.values()]
        if not self._until(lambda: all(over() for over in is_over), self._deadline):
            waiting = (name for name, over in zip(handles, is_over) if not over())
            raise DemoError(f"out of time; waiting: {', '.join(waiting) or 'no robot'}")
        for name, handle in handles.items():
            result = handle.get_result()
            if result.kind != Event.DONE and not (may_be_blocked and result.kind == Event.BLOCKED):
                raise DemoError(f"{name}: its goal was not done: {result.text}")

    def _line_of(self, goal: Any) -> str:
        what = f"carry storage_unit{goal.shelf_id}" if isinstance(goal, CarryGoal) else "go"
        seconds = self._world.fleet.stamp.to_sec()
        return f"{seconds:10.3f} s  kiva{goal.kiva_id:<10} {what} to ({goal.x:g}, {goal.y:g})"

    # --- the world

    def _look(self) -> None:
        """Waits for the warehouse, whose service comes once it is built, and reads its floor."""
        try:
            self._ros.wait_for_service("warehouse/create_warehouse_models", PATIENCE)
        except self._ros.ROSException as error:
            raise DemoError("no warehouse is running") from error
        if not self._until(self._is_ready, min(PATIENCE, self._deadline)):
            raise DemoError(
                "out of time; waiting: no robot, but the actions and the world's topics"
            )
        self._plan = self._world.plan()

    def _is_ready(self) -> bool:
        soon = self._ros.Duration(nsecs=1)  # zero would wait without end
        are_there = all(client.wait_for_server(soon) for client in self._clients.values())
        return are_there and self._world.is_known and self._answers.get_num_connections() > 0

    def _build(self, size: str) -> None:
        create = self._ros.ServiceProxy("warehouse/create_warehouse_models", CreateWarehouse)
        try:
            answer = create(warehouse_name=size)
        except self._ros.ServiceException as error:
            raise DemoError(f"no {size} warehouse: {error}") from error
        if not answer.success:
            raise DemoError(f"no {size} warehouse: {answer.message}")

    def _chart(self) -> Chart:
        plan, world = self._plan, self._world
        passable = np.flatnonzero(plan.passable & ~plan.obstructed)
        return Chart(
            {self._cell(cell) for cell in passable},
            {robot: self._cell(cell) for robot, cell in world.robot_cells(plan).items()},
            {unit: self._cell(cell) for unit, cell in world.standing_units(plan).items()},
        )

    def _cell(self, number: int) -> Point:
        row, column = divmod(int(number), self._plan.width)
        return column, row

    def _point(self, cell: Point) -> tuple[float, float]:
        x, y = self._plan.point_of(cell[1] * self._plan.width + cell[0])
        return float(x), float(y)

    def _on_event(self, event: Event) -> None:
        self._events.append(event)
        # Twenty robots end a path every few seconds.
        if event.kind not in SILENT and "follow path" not in event.text:
            self._write(event_text.line(event))

    def _measure(self, before: FleetState | None, fleet: FleetState) -> None:
        if before is None or before.kiva_id != fleet.kiva_id:
            return
        steps = np.hypot(np.subtract(fleet.x, before.x), np.subtract(fleet.y, before.y))
        turns = np.abs(np.remainder(np.subtract(fleet.yaw, before.yaw) + np.pi, math.tau) - np.pi)
        for robot, step, turn in zip(fleet.kiva_id, steps, turns / (math.pi / 2)):
            self._metres[robot] += step
            self._turns[robot] += turn

    # --- what is expected

    def _check_delivered(self, errand: Errand) -> None:
        robot, name = f"kiva{errand.robot}", f"storage_unit{errand.unit}"
        for kind, word in ((Event.LIFTED, "lifted"), (Event.DROPPED, "dropped")):
            self._expect(f"{robot} {word} {name}", self._has_event, kind, robot, name)
        text = f"{name} stands before {errand.belt}, on the floor, with its items"
        self._expect(text, self._stands, name, self._point(errand.to_belt[-1]))
        self._expect(f"{robot} left it there", self._is_at, errand.robot, errand.exit)

    def _has_event(self, *fact: Any) -> bool:
        return any((e.kind, e.model, e.other) == fact for e in self._events)

    def _stands(self, name: str, point: tuple[float, float]) -> bool:
        known = self._world.objects, self._world.units
        if not self._world.is_known:
            return False
        units, items = tracking.storage_units(*known), tracking.items(*known)
        i = units.names.index(name)
        on_it = items.pose[[unit == name for unit in items.unit]]
        return (
            not units.carrier[i]
            and abs(units.pose[i, 2]) < TOLERANCE
            and math.dist(units.pose[i, :2], point) < TOLERANCE
            and bool((np.hypot(*(on_it[:, :2] - point).T) < ON_UNIT).all())
        )

    def _is_at(self, robot: int, cell: Point) -> bool:
        fleet = self._world.fleet
        i = fleet.kiva_id.index(robot)
        return math.dist((fleet.x[i], fleet.y[i]), self._point(cell)) < TOLERANCE

    def _is_blocked(self) -> bool:
        return not self._models(Event.BLOCKED).isdisjoint(f"kiva{robot}" for robot in self._cast)

    def _models(self, kind: int) -> set[str]:
        return {event.model for event in self._events if event.kind == kind}

    def _expect(self, text: str, condition: Callable[..., Any], *args: Any) -> None:
        """Judges a condition once it holds, or after DELAY: messages may be on their way."""
        self._judge(text, self._until(lambda: condition(*args), DELAY))

    def _judge(self, text: str, is_true: bool) -> None:
        self._write(f"  {'ok    ' if is_true else 'FAILED'}  {text}")
        if not is_true:
            self.failed.append(text)

    def _until(self, condition: Callable[[], Any], patience: float) -> bool:
        """Waits for a condition, at most `patience` [s, wall]; returns whether it holds."""
        end = time.monotonic() + patience
        while not condition():
            if self._ros.is_shutdown():
                raise KeyboardInterrupt
            if time.monotonic() > end:
                return False
            time.sleep(PERIOD)
        return True


@contextmanager
def coordinator() -> Iterator[None]:
    """Runs a coordinator that keeps all stations busy, within a `with` block."""
    # It ends with this process, however that ends.
    node = "setpriv --pdeathsig TERM rosrun warehouse_fleet coordinator _demand:=random"
    process = subprocess.Popen([*node.split(), f"_exchange:={EXCHANGE}"], stdout=subprocess.DEVNULL)
    try:
        yield
    finally:
        process.terminate()
        process.wait()
