# SPDX-License-Identifier: Apache-2.0
"""Keeps a vehicle to its zones: how far along its order it may drive, and the errors of zones."""

import itertools
import math
import time
from collections.abc import Callable, Sequence

from warehouse_vda5050.driver import Report
from warehouse_vda5050.errors import Error, ErrorLevel, ErrorType, Predefined
from warehouse_vda5050.grid import Cell, Grid
from warehouse_vda5050.model import Factsheet, Node, Responses, VehicleOrder
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.demands import Robot, loaded_after
from warehouse_vda5050.vehicle.progress import OrderProgress
from warehouse_vda5050.zones.outline import Box, overlaps
from warehouse_vda5050.zones.releases import Releases
from warehouse_vda5050.zones.route import Stretch, points_of, size_of, stretches
from warehouse_vda5050.zones.store import ZoneStore
from warehouse_vda5050.zones.zone import Zone, ZoneType

AHEAD = 5.0  # the robot asks for a zone when it is this near [m]


class ZoneGuard:
    """The zones of one vehicle. `clock` is the wall clock, by which leases end."""

    def __init__(self, sheet: Factsheet, name: str, clock: Callable[[], float] = time.time) -> None:
        self._sheet, self.clock = sheet, clock
        self.store = ZoneStore(sheet.zone_types)
        self.releases = Releases(name)
        self.limit: int | None = None  # index of the last node that may be driven to, None: any
        self.speeds: list[float] = []  # the highest on each edge of the base [m/s]; inf = any
        self._inside: list[Zone] = []
        self._errors: list[Error] = []

    def take(self, responses: Responses) -> list[str]:
        """Takes a master's answers. Returns the ids of those that answer no active request."""
        wall = self.clock()
        taken = [
            (r.request, self.releases.take(r, self._inside, wall)) for r in responses.responses
        ]
        return [id for id, was_active in taken if not was_active]

    def enable(self, id: str) -> str:
        """Lets another zone set hold. Returns why not, or ''."""
        before = self.store.enabled
        why = self.store.enable(id)
        if self.store.enabled is not before:
            self.releases.clear()
        return why

    def check(self, order: VehicleOrder, cells: Sequence[Cell], robot: Robot) -> None:
        """Raises MessageError for an order through a zone that no release opens."""
        if self.store.enabled is None:
            return
        loaded = _loads(order.nodes, robot.is_loaded)
        way = stretches(points_of(cells, robot.grid), loaded, self._sheet, robot.yaw)
        for node, stretch in zip(order.nodes[1:], way):
            if zone := self._forbidding(stretch):
                refer = (
                    ("orderId", order.id[:100]),
                    ("nodeId", node.id[:100]),
                    ("zoneId", zone.id[:100]),
                )
                text = f"node {node.id[:60]!r} is not reached: {_named(zone)} is on the way to it"
                precise = Predefined.NO_ROUTE_TO_TARGET
                raise MessageError(text, ErrorType.NO_ROUTE.value, refer, precise)

    def _forbidding(self, stretch: Stretch) -> Zone | None:
        return next((zone for zone in self._zones if stretch.is_forbidden(zone)), None)

    @property
    def _zones(self) -> Sequence[Zone]:
        return self.store.enabled.zones if self.store.enabled else ()

    # --- progress

    def update(self, order: OrderProgress | None, grid: Grid, report: Report) -> None:
        """Sees where the robot is and what is before it; order: None if none is under way."""
        self.limit, self.speeds, self._errors, self._inside = None, [], [], []
        zones = self.store.enabled
        if zones is None:
            return
        self._inside = [zone for zone in zones.zones if self._is_in(zone, report)]
        way = self._way(order, grid, report) if order else []
        self.speeds = self._speeds(way)
        needed = self._entered(way, ZoneType.RELEASE)
        soon = itertools.chain(*needed[: _near(way)])
        within = [zone for zone in self._inside if zone.type is ZoneType.RELEASE]
        self.releases.update(soon, within, zones.id, self.clock())
        if order:
            self._limit_to(order, way, needed)
        self._hold()

    def _is_in(self, zone: Zone, report: Report) -> bool:
        size = size_of(self._sheet, bool(report.load))
        return overlaps(zone.vertices, Box(report.x, report.y, report.yaw, *size))

    def _way(self, order: OrderProgress, grid: Grid, report: Report) -> list[Stretch]:
        """Returns the stretches to the nodes of the base, the first from where the robot is."""
        cells = order.cells[: order.base_end + 1]
        points = points_of(cells, grid)
        points[0] = (report.x, report.y)
        loaded = _loads(order.nodes, bool(report.load))
        return list(stretches(points, loaded, self._sheet, report.yaw))

    def _entered(self, way: Sequence[Stretch], type: ZoneType) -> list[list[Zone]]:
        """Returns the zones of a type that the robot's contour enters on each stretch."""
        zones = [zone for zone in self._zones if zone.type is type]
        return [[zone for zone in zones if stretch.enters(zone)] for stretch in way]

    def _speeds(self, way: Sequence[Stretch]) -> list[float]:
        """Returns the highest speed on each stretch [m/s]; inf = any."""
        entered = self._entered(way, ZoneType.SPEED_LIMIT)
        return [min((zone.number for zone in zones), default=math.inf) for zones in entered]

    def _limit_to(
        self, order: OrderProgress, way: Sequence[Stretch], needed: Sequence[Sequence[Zone]]
    ) -> None:
        for k, stretch in enumerate(way):
            if zone := self._forbidding(stretch):
                self.limit = k
                self._errors.append(_unreachable(order, order.nodes[k + 1], zone))
                return
            if not all(map(self.releases.is_granted, needed[k])):
                self.limit = k
                return

    def _hold(self) -> None:
        """Lets the robot stand where it must not be."""
        blocked = [zone for zone in self._inside if zone.type is ZoneType.BLOCKED]
        for zone in blocked:
            text = f"the robot is in {_named(zone)}"
            self._errors.append(_error(zone, text, Predefined.BLOCKED_ZONE_VIOLATION))
        lost = self.releases.lost()
        self._errors += map(_lost, lost)
        if blocked or any(zone.word != "CONTINUE" for zone in lost):
            self.limit = 0

    def errors(self) -> Sequence[Error]:
        """Returns the errors of zones that hold now."""
        return self._errors


def _near(way: Sequence[Stretch]) -> int:
    """Returns how many stretches begin so near that the robot asks for their zones."""
    begins = itertools.accumulate((math.dist(s.start, s.end) for s in way), initial=0.0)
    return sum(far <= AHEAD for far in itertools.islice(begins, len(way)))


def _loads(nodes: Sequence[Node], is_loaded: bool) -> list[bool]:
    """Returns whether the robot is loaded after each node's actions."""
    loaded: list[bool] = []
    for k, node in enumerate(nodes):
        # The load of the first node's actions may be there already or not: the larger counts.
        after = loaded_after(node, is_loaded)
        is_loaded = (after or is_loaded) if k == 0 else after
        loaded.append(is_loaded)
    return loaded


def _named(zone: Zone) -> str:
    return f"{zone.type} zone {zone.id[:60]!r}"


def _unreachable(order: OrderProgress, node: Node, zone: Zone) -> Error:
    text = f"node {node.id[:60]!r} is not reached: {_named(zone)} is on the way to it"
    refer = (("orderId", order.id[:100]), ("nodeId", node.id[:100]), ("zoneId", zone.id[:100]))
    kind, precise = ErrorType.ORDER.value, Predefined.NODE_UNREACHABLE
    return Error(kind, ErrorLevel.WARNING, text, "another order or zone set", refer, precise)


def _error(zone: Zone, text: str, precise: Predefined | None) -> Error:
    refer = (("zoneId", zone.id[:100]),)
    return Error(ErrorType.ZONE.value, ErrorLevel.WARNING, text, "", refer, precise)


def _lost(zone: Zone) -> Error:
    text = f"the release of {_named(zone)} is lost, and the robot is in it"
    if zone.word == "CONTINUE":
        return _error(zone, f"{text}; it goes on, as releaseLossBehavior is CONTINUE", None)
    return _error(zone, text, Predefined.RELEASE_LOST)
