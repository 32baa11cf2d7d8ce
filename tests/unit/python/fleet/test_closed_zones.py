# SPDX-License-Identifier: Apache-2.0
"""Closed zones: a fleet at work keeps out of them, says what waits, and comes back."""

import math

import numpy as np
import pytest
from operations_site import site
from test_failures import Fleet

from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.traffic.closed_zones import MOST, ClosedZone, ClosedZones, ZoneRequest
from warehouse_fleet.transports.transports import Kind, Step
from warehouse_layout.floor.floor_edges import FloorEdges

WARM_UP = 30  # [s]
LEAVES = 45  # in which the last robot has left a zone [s]
SPILL = "spill"


def fleet_site():
    return site(robots=2).plan


PLAN = fleet_site()


def zones_of(plan=PLAN):
    cells = []
    return ClosedZones(plan, FloorEdges(plan.floor()), cells.append), cells


def point(cell, plan=PLAN):
    return tuple(map(float, plan.point_of(int(cell))))


STREET = np.flatnonzero(PLAN.passable & ~PLAN.storage & ~PLAN.lane & ~PLAN.parking)


def request(**fields):
    x, y = point(STREET[0])
    wish = {"x1": x, "y1": y, "x2": x, "y2": y, "reason": SPILL} | fields
    return ZoneRequest(**wish)


# --- what is refused


@pytest.mark.parametrize(
    "fields, text",
    [
        ({"x1": math.nan}, r"\(x1, y1\) is \(nan, .*\); two numbers were expected"),
        ({"y2": math.inf}, r"\(x2, y2\) is \(.*, inf\); two numbers were expected"),
        ({"x2": 1e300}, r"\(x2, y2\) is \(1e\+300, .*\), which is off the floor: its cells reach"),
        ({"x1": -1e4}, r"\(x1, y1\) is \(-10000, .*\), which is off the floor"),
        ({"duration": math.nan}, "duration is nan; 0 .until it is opened. to 604800 s were expect"),
        ({"duration": math.inf}, "duration is inf; 0"),
        ({"duration": -1.0}, "duration is -1; 0"),
        ({"reason": "  "}, "reason is ''; 1 to 60 characters were expected"),
        ({"reason": "a\nb"}, "reason is 'a.nb'; 1 to 60 characters were expected"),
        ({"by": "x" * 61}, "by is 'x*'; up to 60 characters were expected"),
    ],
)
def test_a_request_with_a_fault_closes_nothing(fields, text):
    zones, cells = zones_of()
    with pytest.raises(ValueError, match=text):
        zones.propose(request(**fields), 0.0)
    assert not len(zones) and not cells


def test_neither_the_whole_floor_nor_a_place_without_streets_is_closed():
    zones, _ = zones_of()
    low, high = point(0), point(PLAN.passable.size - 1)
    whole = {"x1": low[0], "y1": low[1], "x2": high[0], "y2": high[1]}
    with pytest.raises(ValueError, match="the whole floor would be closed; stop the robots"):
        zones.propose(request(**whole), 0.0)
    wall = np.flatnonzero(~PLAN.passable)
    if len(wall):
        x, y = point(wall[0])
        with pytest.raises(ValueError, match="no robot drives in that rectangle"):
            zones.propose(request(x1=x, y1=y, x2=x, y2=y), 0.0)


def test_no_more_than_so_many_zones_are_closed():
    zones, _ = zones_of()
    for _ in range(MOST):
        zones.close(zones.propose(request(), 0.0))
    with pytest.raises(ValueError, match=f"{MOST} zones are closed already; open one first"):
        zones.propose(request(), 0.0)


# --- what waits


def test_a_zone_says_before_what_will_wait_and_keeps_nothing_closed():
    zones, cells = zones_of()
    station = PLAN.stations[0]
    x, y = point(station.service_cell)
    zone = zones.propose(request(x1=x, y1=y, x2=x, y2=y), 0.0)
    assert zones.waits(zone, {}) == [f"{station.name} gets no units"]
    assert not cells and not zones.is_cut.any()
    zones.close(zone)
    assert zones.why_station(station.name) == f"{station.name} lies in the closed zone 'spill'"
    assert zones.waits(zone, {}) == [f"{station.name} gets no units"]
    other = PLAN.stations[1].name if len(PLAN.stations) > 1 else ""
    assert not other or zones.why_station(other) == ""


def test_units_within_are_named_and_others_are_cut_off():
    zones, _ = zones_of()
    cell = int(np.flatnonzero(PLAN.storage)[0])
    x, y = point(cell)
    zone = zones.propose(request(x1=x, y1=y, x2=x, y2=y), 0.0)
    assert zones.waits(zone, {23: cell, 24: NOWHERE}) == ["unit 23 can't be fetched"]
    zones.close(zone)
    assert zones.why_unit(23, cell) == "unit 23 stands in the closed zone 'spill'"
    # All streets beside it: the place itself stays open, and no robot leaves it with a unit.
    zones.open(zone.zone_id)
    beside = [c for c in PLAN.beside([cell]).tolist() if c in set(STREET.tolist())]
    for street in beside:
        at = dict(zip(("x1", "y1"), point(street))) | dict(zip(("x2", "y2"), point(street)))
        zones.close(zones.propose(request(**at), 0.0))
    assert zones.why_unit(23, cell).startswith("unit 23 is cut off by the closed zone")


def test_a_zone_opens_by_itself_and_survives_another_time():
    zones, cells = zones_of()
    zones.close(zones.propose(request(duration=60.0), 100.0))
    assert len(cells[-1]) == 1
    assert zones.end_due(159.9) == []
    [over] = zones.end_due(160.0)
    assert over.reason == SPILL and len(cells[-1]) == 0
    with pytest.raises(ValueError, match="there is no closed zone 1"):
        zones.open(1)
    # A world that jumped from 150 s to 10 s has the rest of the time left.
    restored, _ = zones_of()
    assert restored.carry_over([over], 150.0, 10.0) == []
    [zone] = restored
    assert (zone.until, zone.zone_id, restored.last) == (20.0, 1, 1)
    elsewhere = ClosedZone(7, "far", "", 1e6, 1e6, 1e6 + 1, 1e6 + 1, 0.0)
    assert "zone 'far' is open again" in restored.carry_over([elsewhere], 0.0, 0.0)[0]


# --- a fleet at work


def exits_within(plan, edges, part):
    """Returns the storage places that are left by the streets `part`, (cells,) bool, alone."""
    places = np.flatnonzero(plan.storage)
    exits = edges.ahead(True)[places]
    return places[((exits == NOWHERE) | part[exits]).all(1) & (exits != NOWHERE).any(1)]


def one_way_behind(plan, edges, cell):
    """Returns (cells,) bool: the streets from which no street leads to most others once a cell is
    closed, as it is the end of theirs."""
    closed = np.zeros(plan.passable.size, bool)
    closed[cell] = True
    streets = (plan.passable & ~plan.storage & ~plan.lane & ~plan.parking).ravel() & ~closed
    start = np.flatnonzero(streets)[-1]
    ahead = edges.ahead(True)
    back = np.zeros_like(closed)
    back[start] = True
    grown = 0
    while back.sum() != grown:
        grown = back.sum()
        back |= streets & ((ahead != NOWHERE) & back[ahead]).any(1)
    return streets & ~back


@pytest.mark.long
def test_what_is_before_the_closed_end_of_a_one_way_street_is_fetched_and_stored_again():
    """Robots drive a street against its direction that a zone has cut."""
    with Fleet("large") as fleet:
        plan, edges = fleet.driver.plan, FloorEdges(fleet.traffic.floor)
        streets = np.flatnonzero(plan.passable & ~plan.storage & ~plan.lane & ~plan.parking)
        behind = max(
            ((one_way_behind(plan, edges, cell), cell) for cell in streets[:60].tolist()),
            key=lambda pair: len(exits_within(plan, edges, pair[0])),
        )
        places = set(exits_within(plan, edges, behind[0]).tolist())
        fleet.run(WARM_UP)
        close(fleet, [behind[1]])
        units = {unit for unit, cell in fleet.transports.cell_of_unit.items() if cell in places}
        assert len(units) > 3
        assert not fleet.traffic.is_cut[list(places)].any()

        def has_left():
            arrived = {e.shelf_id for e in fleet.events if e.kind == Kind.ARRIVED} & units
            return len(arrived) > 1 and len({*places} & set(stored())) > 0

        def stored():
            after = [e.shelf_id for e in fleet.events if e.kind == Kind.STORED]
            return [fleet.transports.cell_of_unit[unit] for unit in after]

        fleet.until(has_left, 600)
        assert fleet.driver.collisions == 0 and fleet.traffic.watchdog.count == 0


def inside(fleet, zone):
    """Returns (n,) bool: robots in the cells of a zone, by where they are."""
    world, plan = fleet.world.fleet, fleet.driver.plan
    return np.isin(plan.cell_of(world.x, world.y), fleet.traffic.zones.cells_of(zone))


def close(fleet, cells, **fields):
    plan, zones = fleet.driver.plan, fleet.traffic.zones
    x, y = plan.point_of(np.asarray(cells))
    corners = map(float, (x.min(), y.min(), x.max(), y.max()))
    zone = zones.propose(ZoneRequest(*corners, reason=SPILL, **fields), fleet.world.time)
    zones.close(zone)
    return zone


def middle(fleet, half=2):
    """Returns the cells of a square in the middle of the storage."""
    plan = fleet.driver.plan
    rows, columns = np.divmod(np.flatnonzero(plan.storage), plan.width)
    row, column = int(np.median(rows)), int(np.median(columns))
    ys, xs = np.arange(row - half, row + half + 1), np.arange(column - half, column + half + 1)
    return np.add.outer(ys * plan.width, xs).ravel()


def test_robots_leave_a_zone_keep_out_for_the_whole_time_and_come_back():
    with Fleet("medium") as fleet:
        fleet.run(WARM_UP)
        zone = close(fleet, middle(fleet), duration=240.0)
        began = fleet.world.time
        was = inside(fleet, zone)
        entered, delivered = 0, fleet.transports.totals.delivered
        while fleet.world.time < began + 235:
            fleet.step()
            now = inside(fleet, zone)
            # Robots that could no longer stop before the edge come to it, and leave.
            if fleet.world.time > began + 5:
                entered += int((now & ~was).sum())
            was = now
            if fleet.world.time > began + LEAVES:
                assert not now.any(), f"{fleet.world.time - began:.0f} s after"
        assert entered == 0
        assert fleet.transports.totals.delivered > delivered + 20
        held = fleet.transports.held()
        assert all("in the closed zone 'spill'" in why or "cut off" in why for _, why in held)
        assert fleet.until(lambda: not len(fleet.traffic.zones), 30)
        assert not fleet.transports.held()
        assert fleet.until(lambda: inside(fleet, zone).any(), 240)
        assert fleet.driver.collisions == 0 and fleet.traffic.watchdog.count == 0


def test_transports_into_a_zone_wait_and_are_done_after_it():
    with Fleet("medium") as fleet:
        fleet.run(WARM_UP)
        station = fleet.driver.plan.stations[0]
        zone = close(fleet, station.cells)
        fleet.run(LEAVES)
        assert not inside(fleet, zone)[~fleet.traffic.robots.busy].any()
        waiting = [t for t, _ in fleet.transports.held() if t.station == station.name]
        assert waiting
        why = f"{station.name} lies in the closed zone 'spill'"
        assert {why for _, why in fleet.transports.held()} == {why}
        fleet.run(60)
        assert all(t.number in fleet.transports for t in waiting)
        assert not any(
            t.station == station.name and t.step == Step.BRINGING for t in fleet.transports
        )
        fleet.traffic.zones.open(zone.zone_id)
        number = waiting[0].number
        arrived = lambda e: e.transport_id == number and e.kind == Kind.ARRIVED  # noqa: E731
        fleet.until(lambda: any(map(arrived, fleet.events)), 240)
        assert fleet.driver.collisions == 0


def test_a_unit_that_is_brought_into_a_zone_is_put_back_and_fetched_again():
    with Fleet("medium") as fleet:
        fleet.run(WARM_UP)
        stations = {s.name: s for s in fleet.driver.plan.stations}
        aside = (fleet.driver.plan.storage | fleet.driver.plan.lane).ravel()

        def brought():
            steps = [
                t for t in fleet.transports if t.step == Step.BRINGING and t.station in stations
            ]
            return [t for t in steps if not aside[fleet.traffic.robots.cell[t.robot]]]

        transport = fleet.until(brought, 120)[0]
        zone = close(fleet, stations[transport.station].cells)
        fleet.events.clear()
        back = lambda e: e.transport_id == transport.number and e.kind == Kind.RECEIVED  # noqa: E731
        fleet.until(lambda: any(map(back, fleet.events)), 240)
        assert transport.robot == NOWHERE and transport.number in fleet.transports
        fleet.traffic.zones.open(zone.zone_id)
        arrived = lambda e: e.transport_id == transport.number and e.kind == Kind.ARRIVED  # noqa: E731
        fleet.until(lambda: any(map(arrived, fleet.events)), 240)
        assert fleet.driver.collisions == 0


def test_robots_without_work_leave_a_zone_and_none_parks_there():
    with Fleet("small") as fleet:
        fleet.driver.step_until(1.0)
        robots = fleet.traffic.robots
        zone = close(fleet, [int(robots.cell[0])])
        assert inside(fleet, zone).any()
        while inside(fleet, zone).any():
            assert fleet.world.time < 60
            fleet.driver.step_until(fleet.world.time + 0.5)
        for _ in range(20):
            fleet.driver.step_until(fleet.world.time + 1)
            assert not inside(fleet, zone).any()
