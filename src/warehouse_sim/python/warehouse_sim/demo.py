# SPDX-License-Identifier: Apache-2.0
"""The demonstration: two robots fetch two storage units at once, then meet head on; at last a fleet
delivers.

Played over topics alone. What shall come true is checked against the events and the tracked poses.
"""

import math
import subprocess
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Any

from warehouse_client import survey
from warehouse_client.engine import Engine
from warehouse_client.latest import LatestMessages
from warehouse_client.message_check import subscribe
from warehouse_client.routes import goals, route
from warehouse_client.services import is_offered
from warehouse_client.survey import Survey
from warehouse_layout.floor import poses
from warehouse_layout.place.layout import Floor
from warehouse_msgs.msg import (
    CoordinatorState,
    Event,
    Lift,
    TrackedObject,
    TrackedObjects,
    TransportEvent,
)
from warehouse_msgs.srv import CreateWarehouse
from warehouse_sim.missions import Map, Mission, Point, meeting, two_missions
from warehouse_sim.script_executor import Command, ScriptExecutor, command

TOLERANCE = 0.05  # between where something shall be and where it is [m]
PATIENCE = 60.0  # with a warehouse being built [s, wall]
ON_UNIT = 0.6  # an item is no further from its unit's centre [m]
FLEET = "medium"  # the warehouse that a coordinator drives
EXCHANGE = 20  # from one unit to the next at a station [s]
DEADLINE = 10.0  # wall seconds that a simulated one may take

Script = Generator[Command, Event, None]  # yields commands; each is answered by its last event


class DemoError(RuntimeError):
    """Something that shall come true did not; the message says what."""


class Demo:
    """`ros` is rospy, `executor` a ScriptExecutor; `tell(text)` reaches who watches."""

    def __init__(
        self, ros: ModuleType, executor: ScriptExecutor, tell: Callable[[str], object]
    ) -> None:
        self._ros, self._executor, self._tell = ros, executor, tell
        self._standing: Any = None
        self.cast: list[int] = []
        self.failed: list[str] = []
        self._newest = LatestMessages(
            ros,
            units=("storage_units", TrackedObjects),
            items=("items", TrackedObjects),
        )

    def play(self) -> None:
        """Plays all acts. Raises NoRouteError, DeadlineError or DemoError if it can't go on."""
        self._look()
        missions = two_missions(self._map())
        self.cast = [mission.kiva for mission in missions]
        for kiva in self.cast:
            self._executor.watch(kiva)
        self._fetch(missions)
        self._meet(self._line_up())
        for kind, name in ((Event.REFUSED, "refused"), (Event.COLLISION, "a collision")):
            self._expect(f"nothing was {name}", not self._models(kind))

    def deliver(self, seconds: float) -> None:
        """Plays the last act: a fleet delivers for so long [s, simulated]. Raises DemoError."""
        self._tell(f"\nThe robots of a {FLEET} warehouse bring storage units to the stations.\n")
        if is_offered(self._ros, "warehouse/transport"):
            raise DemoError("a coordinator runs already; the demonstration brings its own")
        fleet = FleetWatch(self._ros)
        self._build(FLEET)
        before = len(self._executor.events)
        with coordinator():
            if not self._executor.until(lambda: fleet.robots > 0, PATIENCE):
                raise DemoError(fleet.alarm or "no coordinator tells of its robots")
            end = fleet.time + seconds
            self._executor.until(lambda: fleet.time >= end, PATIENCE + DEADLINE * seconds)
        after = self._executor.events[before:]
        self._expect(f"{fleet.robots} robots were coordinated for {seconds:g} s", fleet.time >= end)
        self._expect(f"{fleet.delivered} storage units were delivered", fleet.delivered > 0)
        self._expect("there was no collision", not any(e.kind == Event.COLLISION for e in after))
        self._expect("every robot moved on", not fleet.watchdog)

    def _build(self, size: str) -> None:
        create = self._ros.ServiceProxy("warehouse/create_warehouse_models", CreateWarehouse)
        try:
            answer = create(warehouse_name=size)
        except self._ros.ServiceException as error:
            raise DemoError(f"no {size} warehouse: {error}") from error
        if not answer.success:
            raise DemoError(f"no {size} warehouse: {answer.message}")

    # --- the acts

    def _fetch(self, missions: list[Mission]) -> None:
        self._tell("\nEach robot brings a storage unit to a conveyor belt, both at once.\n")
        self._executor.play({m.kiva: self._fetching(m) for m in missions})
        for mission in missions:
            self._check_delivered(mission)

    def _fetching(self, mission: Mission) -> Script:
        kiva, unit = mission.kiva, mission.unit
        yield from _drive(kiva, mission.to_unit)
        yield from _do(command("lift", kiva, status=Lift.CARRY, shelf_id=unit))
        yield from _drive(kiva, mission.to_drop)
        yield from _do(command("lift", kiva, status=Lift.DROP, shelf_id=unit))
        # Out beneath the unit, by the way it came in.
        yield from _drive(kiva, [mission.to_drop[-1], mission.out])

    def _line_up(self) -> dict[int, Point]:
        """Brings both to the ends of an aisle; returns where each wants to go then."""
        self._tell("\nThey line up at the two ends of an aisle.\n")
        chart, (a, b) = self._map(), self.cast
        aisles = chart.grid(self.cast, also=chart.units.values())
        end_a, end_b = meeting(aisles, chart.robots[a], chart.robots[b])
        self._executor.play({a: _drive(a, route(chart.grid([a]), chart.robots[a], end_a))})
        after = chart.grid(self.cast, also=[end_a])
        self._executor.play({b: _drive(b, route(after, chart.robots[b], end_b))})
        return {a: end_b, b: end_a}

    def _meet(self, goals: dict[int, Point]) -> None:
        self._tell("\nEach sets off for the other's place. A blocked robot finds another way.\n")
        self._executor.play({kiva: _try(kiva, goal) for kiva, goal in goals.items()})
        blocked = self._models(Event.BLOCKED) & {f"kiva{kiva}" for kiva in self.cast}
        self._expect("meeting head on, one of them was blocked at least", blocked)
        for kiva, goal in goals.items():
            chart = self._map()
            way = route(chart.grid([kiva]), chart.robots[kiva], goal)
            self._executor.play({kiva: _drive(kiva, way)})
            arrived = math.dist(self._robot(kiva)[:2], goal) < TOLERANCE
            self._expect(f"kiva{kiva} reached ({goal[0]}, {goal[1]}) all the same", arrived)

    # --- what is there

    def _look(self) -> None:
        """Where everything stands, once it does: the service comes when its warehouse is built."""
        try:
            self._ros.wait_for_service("warehouse/create_warehouse_models", PATIENCE)
        except self._ros.ROSException as error:
            raise DemoError("no warehouse is running") from error
        with Engine(self._ros) as engine:
            self._standing = survey.of_engine(engine)
        if not self._executor.until(self._is_tracked, PATIENCE):
            raise DemoError("the tracking nodes do not publish where storage units and items are")

    def _is_tracked(self) -> bool:
        """Whether the tracking nodes know of all that stands."""
        units, items = self._newest["units"], self._newest["items"]
        if not (units and items):
            return False
        known = (len(units.objects), len(items.objects))
        return known == (len(self._standing.storage_unit), len(self._standing.item))

    def _map(self) -> Map:
        """Returns the map as it is now: the cast by status, the units by tracked poses."""
        self._standing.kiva |= {kiva: self._robot(kiva) for kiva in self.cast}
        tracked = of_tracked(self._newest["units"])
        self._standing.storage_unit = tracked.storage_unit
        bounds = self._ros.get_param("warehouse/floor", None)
        return Map(self._standing, Floor(*bounds) if bounds else None)

    def _robot(self, kiva: int) -> tuple[float, float, float]:
        status = self._executor.status(kiva)
        if status is None:
            raise DemoError(f"kiva{kiva} has not reported where it is")
        return status.pose.x, status.pose.y, status.pose.theta

    def _models(self, kind: int) -> set[str]:
        """Who had such an event."""
        return {event.model for event in self._executor.events if event.kind == kind}

    # --- what shall have come true

    def _check_delivered(self, mission: Mission) -> None:
        name, belt = f"storage_unit{mission.unit}", f"conveyor_belt{mission.belt}"
        for kind, word in ((Event.LIFTED, "lifted"), (Event.DROPPED, "dropped")):
            self._expect(f"kiva{mission.kiva} {word} {name}", self._happened(kind, mission, name))
        stands = self._executor.until(lambda: self._stands(name, mission.to_drop[-1]))
        self._expect(f"{name} stands before {belt}, on the floor, with its items", stands)
        left = math.dist(self._robot(mission.kiva)[:2], mission.out) < TOLERANCE
        self._expect(f"kiva{mission.kiva} left it there", left)

    def _happened(self, kind: int, mission: Mission, name: str) -> bool:
        fact = (kind, f"kiva{mission.kiva}", name)
        return any((e.kind, e.model, e.other) == fact for e in self._executor.events)

    def _stands(self, name: str, at: Point) -> bool:
        unit = next((o for o in self._newest["units"].objects if o.name == name), None)
        items = [o for o in self._newest["items"].objects if o.storage_unit == name]
        if unit is None or unit.carrier or abs(unit.pose.position.z) > TOLERANCE:
            return False
        with_it = all(_away(item, at) < ON_UNIT for item in items)
        return _away(unit, at) < TOLERANCE and with_it

    def _expect(self, text: str, true: object) -> None:
        self._tell(f"  {'ok    ' if true else 'FAILED'}  {text}")
        if not true:
            self.failed.append(text)


class FleetWatch:
    """What the coordinator tells. `ros` is rospy."""

    def __init__(self, ros: ModuleType) -> None:
        self._state, self.delivered = CoordinatorState(), 0
        subscribe(ros, "warehouse/coordinator", CoordinatorState, self._take, queue_size=1)
        subscribe(ros, "warehouse/transports", TransportEvent, self._count, queue_size=1000)

    def _take(self, state: CoordinatorState) -> None:
        self._state = state

    def _count(self, event: TransportEvent) -> None:
        self.delivered += event.kind == TransportEvent.ARRIVED

    @property
    def time(self) -> float:
        """The time of the last state [s, simulated]."""
        return self._state.header.stamp.to_sec()

    @property
    def robots(self) -> int:
        """How many robots the coordinator commands."""
        return self._state.automatic

    @property
    def watchdog(self) -> int:
        """How often robots made no progress."""
        return self._state.watchdog

    @property
    def alarm(self) -> str:
        """The coordinator's first alarm, or nothing."""
        return "; ".join(self._state.alarms)


@contextmanager
def coordinator() -> Iterator[None]:
    """Runs a coordinator that keeps all stations busy, within a `with` block."""
    # It ends with this process, however that ends.
    node = [
        "setpriv",
        "--pdeathsig",
        "TERM",
        "rosrun",
        "warehouse_fleet",
        "coordinator",
        "_demand:=random",
    ]
    process = subprocess.Popen([*node, f"_exchange:={EXCHANGE}"], stdout=subprocess.DEVNULL)
    try:
        yield
    finally:
        process.terminate()
        process.wait()


def of_tracked(message: TrackedObjects) -> Survey:
    """Returns a Survey of the objects in a TrackedObjects message."""
    planar = poses.planar_of(o.pose for o in message.objects)
    return survey.of_models({o.name: tuple(at) for o, at in zip(message.objects, planar)})


def _away(tracked: TrackedObject, at: Point) -> float:
    return math.dist((tracked.pose.position.x, tracked.pose.position.y), at)


def _drive(kiva: int, points: list[Point]) -> Script:
    """A script: along a route, point by point. Raises DemoError if anything stops the robot."""
    for x, y in goals(points):
        yield from _do(command("mov", kiva, x=x, y=y))


def _do(wish: Command) -> Script:
    event = yield wish
    if event.kind != Event.DONE:
        raise DemoError(f"{event.model}: {wish} was not done: {event.text}")


def _try(kiva: int, goal: Point) -> Script:
    """A script: straight to the goal, as far as it goes."""
    yield command("mov", kiva, x=goal[0], y=goal[1])
