# SPDX-License-Identifier: Apache-2.0
"""Zones of the floor that people close for a time: no robot of the fleet enters them, and those
inside leave."""

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.traffic.reach import Reach
from warehouse_fleet.traffic.station_ways import StationWays
from warehouse_layout.floor.floor_edges import FloorEdges
from warehouse_layout.floor.floor_plan import FloorPlan

MOST = 50  # zones at a time
LONGEST = 7 * 24 * 3600.0  # [s]
MOST_REASON, MOST_NAME = 60, 60  # characters
NAMED = 5  # units that are named; the others are counted


@dataclass(frozen=True)
class ClosedZone:
    """A rectangle that is closed: its edges in world [m], and from when to when [s]."""

    zone_id: int
    reason: str
    by: str  # name of the person; empty: not known
    x_min: float
    y_min: float
    x_max: float
    y_max: float
    since: float
    until: float = math.inf


@dataclass(frozen=True)
class ZoneRequest:
    """The wish to close the rectangle between two corners [m] for a duration [s]; 0: until it is
    opened."""

    x1: float
    y1: float
    x2: float
    y2: float
    duration: float = 0.0
    reason: str = ""
    by: str = ""


class ClosedZones:
    """The closed zones on a FloorPlan. `apply(cells)` gets the cells, (n,) int32, of all zones at
    each change. Numbers of zones begin after `last`."""

    def __init__(
        self,
        plan: FloorPlan,
        edges: FloorEdges,
        apply: Callable[[np.ndarray], None],
        last: int = 0,
    ) -> None:
        self._plan, self._floor_edges, self._apply = plan, edges, apply
        self.last = last
        self._ways = StationWays(plan)
        self._zones: dict[int, ClosedZone] = {}
        self._reason_in: dict[int, str] = {}  # by cell
        self._reach = Reach(plan, edges, self._ways, frozenset())

    def __iter__(self) -> Iterator[ClosedZone]:
        return iter(list(self._zones.values()))

    def __len__(self) -> int:
        return len(self._zones)

    @property
    def is_cut(self) -> np.ndarray:
        """(cells,) bool: closed, or cut off by zones."""
        return self._reach.is_cut

    @property
    def cells(self) -> list[int]:
        """The cells of all zones."""
        return list(self._reason_in)

    def holds(self, cell: int) -> bool:
        """Returns whether a cell lies in a zone."""
        return cell in self._reason_in

    def cells_of(self, zone: ClosedZone) -> np.ndarray:
        """Returns the cells (n,) int32 of a zone."""
        plan, inner = self._plan, self._plan.spacing / 2
        low = plan.cell_of(zone.x_min + inner, zone.y_min + inner)
        high = plan.cell_of(zone.x_max - inner, zone.y_max - inner)
        (y1, x1), (y2, x2) = divmod(low, plan.width), divmod(high, plan.width)
        rows, columns = np.arange(y1, y2 + 1), np.arange(x1, x2 + 1)
        return np.add.outer(rows * plan.width, columns).ravel().astype(np.int32)

    def propose(self, request: ZoneRequest, now: float) -> ClosedZone:
        """Returns the zone that a request is for, which is not closed yet. Raises ValueError with
        what is wrong."""
        reason, by = request.reason.strip(), request.by.strip()
        if not reason or len(reason) > MOST_REASON or not reason.isprintable():
            raise ValueError(f"reason is {reason!r}; 1 to {MOST_REASON} characters were expected")
        if len(by) > MOST_NAME or not (by.isprintable() or not by):
            raise ValueError(f"by is {by!r}; up to {MOST_NAME} characters were expected")
        if not 0 <= request.duration <= LONGEST:
            raise ValueError(
                f"duration is {request.duration:g}; 0 (until it is opened) to {LONGEST:.0f} s"
                " were expected"
            )
        if len(self._zones) >= MOST:
            raise ValueError(f"{MOST} zones are closed already; open one first")
        until = now + request.duration if request.duration else math.inf
        zone = ClosedZone(self.last + 1, reason, by, *self._edges(request), now, until)
        cells = self.cells_of(zone)
        drivable = self._plan.passable.ravel()
        if not drivable[cells].any():
            raise ValueError("no robot drives in that rectangle")
        others = np.setdiff1d(np.flatnonzero(drivable), [*self._reason_in, *cells.tolist()])
        if not len(others):
            raise ValueError(
                "with that zone the whole floor would be closed; stop the robots instead"
            )
        return zone

    def _edges(self, request: ZoneRequest) -> tuple[float, float, float, float]:
        plan, half = self._plan, self._plan.spacing / 2
        points = []
        for names, x, y in (("x1, y1", request.x1, request.y1), ("x2, y2", request.x2, request.y2)):
            if not (math.isfinite(x) and math.isfinite(y)):
                raise ValueError(f"({names}) is ({x:g}, {y:g}); two numbers were expected")
            # The floor's edges are compared first: cells beyond are no integers of 32 bits.
            height, width = plan.shape
            is_on = (
                -half <= x - plan.origin[0] < width * plan.spacing - half
                and -half <= y - plan.origin[1] < height * plan.spacing - half
            )
            if not is_on:
                raise ValueError(f"({names}) is ({x:g}, {y:g}), {self._beside()}")
            points.append(plan.point_of(plan.cell_of(x, y)))
        (xa, ya), (xb, yb) = points
        low_x, high_x = sorted((float(xa), float(xb)))
        low_y, high_y = sorted((float(ya), float(yb)))
        return low_x - half, low_y - half, high_x + half, high_y + half

    def _beside(self) -> str:
        plan = self._plan
        x, y = plan.point_of(plan.passable.size - 1)
        return (
            f"which is off the floor: its cells reach from ({plan.origin[0]:g},"
            f" {plan.origin[1]:g}) to ({x:g}, {y:g})"
        )

    def close(self, zone: ClosedZone) -> None:
        """Closes a proposed zone, or one of before."""
        self.last = max(self.last, zone.zone_id)
        self._zones[zone.zone_id] = zone
        self._update()

    def open(self, zone_id: int) -> ClosedZone:
        """Opens a zone, and returns it. Raises ValueError if no zone has that number."""
        if zone_id not in self._zones:
            raise ValueError(f"there is no closed zone {zone_id}")
        zone = self._zones.pop(zone_id)
        self._update()
        return zone

    def end_due(self, now: float) -> list[ClosedZone]:
        """Opens the zones whose time is over, and returns them."""
        over = [zone for zone in self._zones.values() if now >= zone.until]
        for zone in over:
            del self._zones[zone.zone_id]
        if over:
            self._update()
        return over

    def carry_over(self, zones: Iterable[ClosedZone], before: float, now: float) -> list[str]:
        """Closes zones of a fleet of before, which lasted until its time `before` [s], with what
        is left of their durations. Returns a sentence for each that does not lie on this floor."""
        lost = []
        for zone in zones:
            shift = 0.0 if zone.since <= now and before <= now else now - before
            try:
                for x, y in ((zone.x_min, zone.y_min), (zone.x_max, zone.y_max)):
                    if not math.isfinite(x + y):
                        raise ValueError("its edges are no numbers")
                half = self._plan.spacing / 2
                corners = ZoneRequest(
                    zone.x_min + half, zone.y_min + half, zone.x_max - half, zone.y_max - half
                )
                edges = self._edges(corners)
            except ValueError as error:
                lost.append(f"the zone '{zone.reason}' is open again: {error}")
                continue
            times = zone.since + shift, zone.until + shift
            moved = ClosedZone(zone.zone_id, zone.reason, zone.by, *edges, *times)
            self._zones[zone.zone_id] = moved
            self.last = max(self.last, zone.zone_id)
        self._update()
        return lost

    def _update(self) -> None:
        self._reason_in = {
            cell: zone.reason
            for zone in reversed(self._zones.values())
            for cell in self.cells_of(zone).tolist()
        }
        cells = np.array(sorted(self._reason_in), np.int32)
        self._reach = self._reach_without(self._reason_in)
        self._apply(cells)

    def _reach_without(self, closed: Collection[int]) -> Reach:
        return Reach(self._plan, self._floor_edges, self._ways, frozenset(closed))

    def why_unit(self, unit: int, cell: int) -> str:
        """Returns why a unit that stands in a cell can't be fetched; empty if it can."""
        if cell == NOWHERE or not self.is_cut[cell]:
            return ""
        if cell in self._reason_in:
            return f"unit {unit} stands in the closed zone '{self._reason_in[cell]}'"
        return f"unit {unit} is cut off by {self._names()}"

    def why_station(self, station: str) -> str:
        """Returns why no unit can be brought to a station; empty if it can."""
        if station not in self._reach.stations:
            return ""
        lane = self._plan.station(station).cells.tolist()
        reason = next((self._reason_in[cell] for cell in lane if cell in self._reason_in), "")
        if reason:
            return f"{station} lies in the closed zone '{reason}'"
        return f"{station} is cut off by {self._names()}"

    def why_cell(self, cell: int) -> str:
        """Returns why nothing can be brought to a cell; empty if it can."""
        if cell == NOWHERE or not self.is_cut[cell]:
            return ""
        x, y = self._plan.point_of(cell)
        if cell in self._reason_in:
            return f"({x:g}, {y:g}) lies in the closed zone '{self._reason_in[cell]}'"
        return f"({x:g}, {y:g}) is cut off by {self._names()}"

    def _names(self) -> str:
        reasons = [f"'{zone.reason}'" for zone in self._zones.values()]
        return f"the closed zone{'s' if len(reasons) > 1 else ''} {', '.join(reasons)}"

    def waits(self, zone: ClosedZone, cell_of_unit: Mapping[int, int]) -> list[str]:
        """Returns a sentence for each station, and one for all units, that wait while a zone is
        closed and would not without it. The zone may be a proposal."""
        others = {
            cell
            for other in self._zones.values()
            if other.zone_id != zone.zone_id
            for cell in self.cells_of(other).tolist()
        }
        before = self._reach_without(others)
        after = self._reach_without({*others, *self.cells_of(zone).tolist()})
        out = [f"{name} gets no units" for name in sorted(after.stations - before.stations)]
        cut = after.is_cut & ~before.is_cut
        units = sorted(u for u, cell in cell_of_unit.items() if cell != NOWHERE and cut[cell])
        if units:
            named = ", ".join(str(unit) for unit in units[:NAMED])
            more = f" and {len(units) - NAMED} more" if len(units) > NAMED else ""
            what = "unit" if len(units) == 1 else "units"
            out.append(f"{what} {named}{more} can't be fetched")
        return out
