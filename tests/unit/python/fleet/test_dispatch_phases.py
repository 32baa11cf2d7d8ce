# SPDX-License-Identifier: Apache-2.0
"""Each phase of the dispatcher alone: what it is constructed from, and what it does to that. No
fleet, no world and no planner is built; the floor is a row of storage places along a street."""

import numpy as np
import pytest

from warehouse_fleet.robots.failures import STANDS
from warehouse_fleet.robots.robot_table import NOWHERE, REPORT, RobotTable
from warehouse_fleet.traffic.station_ways import StationWays
from warehouse_fleet.transports.charging import Charging, Threshold
from warehouse_fleet.transports.completion import Completion
from warehouse_fleet.transports.dispatch.admit import Admission
from warehouse_fleet.transports.dispatch.arrive import Arrival
from warehouse_fleet.transports.dispatch.assign import FETCHED, Assignment, nearest_robots
from warehouse_fleet.transports.dispatch.clear import Clearing
from warehouse_fleet.transports.dispatch.depart import Departure
from warehouse_fleet.transports.dispatch.lift import LIFT_ATTEMPTS, LIFT_PATIENCE, LiftWatch
from warehouse_fleet.transports.dispatch.park import Parking
from warehouse_fleet.transports.dispatch.recover import DEAD, URGENT, Recovery
from warehouse_fleet.transports.dispatch.reject import Rejection
from warehouse_fleet.transports.distances import Distances
from warehouse_fleet.transports.journeys import Journeys
from warehouse_fleet.transports.lifts import LiftOrder, Lifts
from warehouse_fleet.transports.storing import Storing
from warehouse_fleet.transports.streets import Streets
from warehouse_fleet.transports.transport_book import STAY, Kind, Leave, Step, TransportBook
from warehouse_fleet.transports.unfit_units import ASKS_AGAIN, UnfitUnits
from warehouse_fleet.transports.unit_map import UnitMap
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.stations import PICK, Station
from warehouse_layout.message_enums import RobotMode, Status

WIDTH = 10  # cells: row 0 is a street, row 1 has storage places, row 2 is the lane of a station
PICK1, SERVICE = "pick1", 22
UNIT, PLACE = 7, 13  # where it stands at first
STREET = 4
NO_CELLS = np.zeros(0, np.int32)


def floor_plan():
    storage = np.zeros((3, WIDTH), bool)
    storage[1, 1:9] = True
    lane = np.arange(20, 25, dtype=np.int32)
    return FloorPlan.laid_out(
        origin=(0.0, 0.0),
        spacing=1.0,
        passable=np.ones(storage.shape, bool),
        storage=storage,
        parking=np.zeros_like(storage),
        exits=np.full(storage.shape, 15, np.uint8),
        stations=[Station(PICK1, PICK, lane, 2)],
    )


class Roads:
    """Traffic as the phases see it: a time, cells that are closed, robots that have arrived."""

    def __init__(self):
        self.time = 100.0
        self.closed = NO_CELLS
        self.is_cut = np.zeros(3 * WIDTH, bool)
        self.with_units = []
        self.at_goal = []

    def set_units(self, cells):
        self.with_units = sorted(cells)

    def arrived(self, among):
        return np.array([robot for robot in self.at_goal if among[robot]], int)

    def journey(self, robot):
        return 3.0, 2.0, 5

    def shortest(self, begin, end, loaded=False):
        return 4


class Desk:
    """The collaborators of the phases, for two robots in the street and a unit in its place."""

    def __init__(self, robots=2):
        plan = floor_plan()
        self.roads = Roads()
        self.robots = RobotTable(np.arange(1, robots + 1))
        self.robots.cell[:] = np.arange(robots)
        self.robots.stands[:] = True
        self.book = TransportBook(self.robots.kiva_ids, self.roads, stations=[PICK1])
        self.units = UnitMap(plan)
        self.units.update({UNIT: PLACE}, 0.0, [])
        self.distances = Distances(WIDTH)
        self.aside = plan.storage.ravel()
        self.lifts = Lifts(self.book, self.robots)
        self.streets = Streets(self.units, self.roads, StationWays(plan))
        self.completion = Completion(self.book, self.robots)
        self.journeys = Journeys(self.robots, self.roads, self.book.totals)
        self.storing = Storing(
            self.aside,
            self.book,
            self.robots,
            self.units,
            self.roads,
            self.journeys,
            lambda _unit, cell, free: self.distances.nearest(cell, free),
        )

    def transport(self, *steps, robot=0, unit=UNIT, station=PICK1, cell=SERVICE, **options):
        """Returns a transport that has gone through some steps after OPEN."""
        transport = self.book.add(unit, station, cell, **options)
        self.book.enqueue(transport)
        if steps:
            self.book.assign(transport, robot)
        for step in steps[1:]:
            self.book.go_on(transport, step)
        return transport

    def kinds(self):
        return [event.kind for event in self.book.take_events()]

    def reports(self, **columns):
        reports = np.zeros(len(self.robots), REPORT)
        for name, values in columns.items():
            reports[name] = values
        return reports


LIFTING = Step.FETCHING, Step.READY, Step.LIFTING
BRINGING = *LIFTING, Step.BRINGING
WAITING = *BRINGING, Step.WAITING


@pytest.fixture
def desk():
    return Desk()


# --- recover


@pytest.fixture
def recovery(desk):
    return Recovery(desk.book, desk.robots, desk.units, desk.roads, desk.storing, desk.completion)


def test_a_transport_is_open_again_when_its_robot_breaks_before_the_lift(desk, recovery):
    transport = desk.transport(Step.FETCHING)
    desk.robots.broken[0] = True
    recovery.run(desk.reports(failures=STANDS))
    assert (transport.step, transport.robot) == (Step.OPEN, NOWHERE)
    assert desk.book.open == [transport] and desk.kinds() == []


@pytest.mark.parametrize(
    ("column", "value", "text"),
    [
        ("mode", RobotMode.MANUAL, "its robot is MANUAL now"),
        ("gone", True, "its robot was removed from the world"),
        ("stalled_since", 100.0 - DEAD - 0.1, "its robot does not move"),
    ],
)
def test_a_transport_fails_with_the_robot_that_carries_its_unit(
    desk, recovery, column, value, text
):
    desk.transport(*BRINGING)
    getattr(desk.robots, column)[0] = value
    if column == "gone":
        desk.robots.mode[0] = RobotMode.OUT_OF_SERVICE
    recovery.run(desk.reports())
    (event,) = desk.book.take_events()
    assert (event.kind, event.text) == (Kind.FAILED, text)
    assert list(desk.book) == [] and desk.book.totals.failed == 1
    assert desk.completion.take_freed() == [0]


def test_a_unit_that_a_lost_robot_left_in_a_street_is_fetched_at_once(desk, recovery):
    desk.transport(*BRINGING)
    desk.robots.mode[0] = RobotMode.MANUAL
    recovery.run(desk.reports())
    desk.units.update({UNIT: STREET}, 101.0, [])
    recovery.store_abandoned()
    (transport,) = desk.book.open
    assert (transport.shelf, transport.priority) == (UNIT, URGENT)
    assert transport.leave == Leave.RELEASED
    desk.kinds()
    recovery.store_abandoned()
    assert desk.book.open == [transport] and desk.kinds() == []


def test_a_robot_that_carries_a_unit_without_a_transport_stores_it(desk, recovery):
    recovery.run(desk.reports(shelf_id=[0, UNIT]))
    transport = desk.book.of_robot[1]
    assert (transport.shelf, transport.step) == (UNIT, Step.STORING)
    assert desk.aside[desk.robots.goal[1]] and desk.robots.goal[1] == transport.place
    assert desk.kinds() == [Kind.RECEIVED]


def test_a_unit_gets_another_place_when_its_own_is_closed(desk, recovery):
    transport = desk.transport(*BRINGING, Step.STORING)
    desk.book.keep(transport, PLACE)
    desk.roads.closed = np.array([PLACE])
    recovery.run(desk.reports(shelf_id=[UNIT, 0]))
    assert transport.place not in (PLACE, NOWHERE)
    assert desk.robots.goal[0] == transport.place


# --- lift


@pytest.fixture
def lift_watch(desk):
    return LiftWatch(
        desk.book,
        desk.robots,
        desk.lifts,
        desk.streets,
        desk.journeys,
        desk.storing,
        desk.completion,
    )


def begin_lift(desk, *steps, **options):
    transport = desk.transport(*steps[:-1], **options)
    desk.lifts.begin(transport, steps[-1])
    return transport


def test_a_unit_that_is_lifted_is_brought_and_its_place_is_kept(desk, lift_watch):
    transport = begin_lift(desk, *LIFTING)
    lift_watch.run(desk.reports(shelf_id=[UNIT, 0], status=Status.BUSY))
    assert transport.step == Step.LIFTING
    lift_watch.run(desk.reports(shelf_id=[UNIT, 0]))
    assert transport.step == Step.BRINGING and desk.kinds() == [Kind.LIFTED]
    assert (desk.robots.goal[0], desk.robots.home[0]) == (SERVICE, PLACE)
    assert desk.book.kept_places().tolist() == [PLACE]
    assert desk.units.cell_of[UNIT] == NOWHERE and desk.robots.loaded[0]


def test_a_unit_that_is_not_to_be_brought_is_stored_again(desk, lift_watch):
    transport = begin_lift(desk, *LIFTING)
    transport.leave = Leave.CANCELLED
    lift_watch.run(desk.reports(shelf_id=[UNIT, 0]))
    assert transport.step == Step.STORING and desk.aside[desk.robots.goal[0]]


def test_a_lift_is_tried_again_and_fails_in_the_end(desk, lift_watch):
    transport = begin_lift(desk, *LIFTING)
    for attempt in range(1, LIFT_ATTEMPTS):
        desk.roads.time += LIFT_PATIENCE + 0.1
        lift_watch.run(desk.reports())
        assert transport.attempts == attempt + 1
    assert desk.lifts.take() == [LiftOrder(1, UNIT, True)] * LIFT_ATTEMPTS
    desk.roads.time += LIFT_PATIENCE + 0.1
    lift_watch.run(desk.reports())
    assert desk.kinds() == [Kind.FAILED] and not desk.robots.busy[0]


def test_a_robot_that_was_pushed_drives_back_before_it_lifts(desk, lift_watch):
    transport = begin_lift(desk, *LIFTING)
    desk.robots.astray[0] = True
    lift_watch.run(desk.reports())
    assert transport.step == Step.FETCHING and not desk.robots.busy[0]


def test_a_unit_that_is_put_down_off_the_storage_places_closes_its_cell(desk, lift_watch):
    begin_lift(desk, *WAITING, Step.DROPPING)
    desk.robots.cell[0] = STREET
    lift_watch.run(desk.reports())
    assert desk.kinds() == [Kind.STORED] and list(desk.book) == []
    assert desk.units.cell_of[UNIT] == STREET and desk.roads.with_units == [STREET]
    assert desk.book.totals.stored == 1 and desk.completion.take_freed() == [0]


# --- arrive


def test_a_robot_that_arrives_goes_on_by_the_step_of_its_transport():
    for steps, after in ((LIFTING[:1], Step.READY), ((*BRINGING, Step.STORING), Step.DROPPING)):
        desk, delivered = Desk(), []
        transport = desk.transport(*steps)
        arrival = Arrival(desk.book, desk.robots, desk.journeys, desk.lifts, delivered.append)
        arrival.run()
        assert transport.step == steps[-1]
        desk.roads.at_goal = [0, 1]  # the other robot has no transport
        arrival.run()
        assert transport.step == after and delivered == []
        assert (desk.book.totals.driven, desk.book.totals.cells) == (3.0, 5)


def test_a_unit_that_arrives_at_its_destination_is_reported(desk):
    delivered = []
    transport = desk.transport(*BRINGING)
    desk.roads.at_goal = [0]
    Arrival(desk.book, desk.robots, desk.journeys, desk.lifts, delivered.append).run()
    assert delivered == [transport] and desk.robots.busy[0]


# --- depart


def test_units_leave_in_the_order_in_which_robots_got_them(desk):
    departure = Departure(desk.book, desk.robots, desk.lifts, desk.storing)
    first = desk.transport(*WAITING, robot=1)
    second = desk.transport(*WAITING, robot=0, unit=UNIT + 1)
    departure.add(second)
    departure.add(first)
    departure.run()
    assert [event.kiva_id for event in desk.book.take_events()] == [2, 1]
    assert {first.step, second.step} == {Step.STORING} and first.place != second.place
    departure.run()
    assert desk.kinds() == []


def test_a_unit_that_stays_is_put_down(desk):
    transport = desk.transport(*WAITING, station="", cell=STREET, then=STAY)
    departure = Departure(desk.book, desk.robots, desk.lifts, desk.storing)
    departure.add(transport)
    departure.run()
    assert desk.kinds() == [Kind.RELEASED]
    assert desk.lifts.take() == [LiftOrder(1, UNIT, False)]


# --- admit


def admission(desk, capacity=1):
    return Admission(desk.book, desk.robots, desk.lifts, desk.streets, {PICK1: capacity})


def ready(desk, robot=0, unit=UNIT):
    transport = desk.transport(Step.FETCHING, Step.READY, robot=robot, unit=unit)
    desk.robots.goal[robot] = desk.robots.cell[robot]
    return transport


def test_as_many_units_are_lifted_as_a_station_has_room_for(desk):
    desk.units.update({UNIT: PLACE, UNIT + 1: PLACE + 1}, 0.0, [])
    first, second = ready(desk), ready(desk, 1, UNIT + 1)
    phase = admission(desk)
    phase.run()
    assert (first.step, second.step) == (Step.LIFTING, Step.READY)
    for step in (Step.BRINGING, Step.WAITING, Step.STORING):
        phase.run()
        assert second.step == Step.READY
        desk.book.go_on(first, step)
    phase.run()
    assert second.step == Step.LIFTING


def test_no_unit_is_lifted_for_a_lane_that_is_closed_or_by_a_robot_beside_it(desk):
    transport = ready(desk)
    phase = admission(desk)
    desk.roads.closed = np.array([SERVICE])
    phase.run()
    desk.roads.closed, desk.robots.stands[0] = NO_CELLS, False
    phase.run()
    assert transport.step == Step.READY
    desk.robots.stands[0] = True
    phase.run()
    assert transport.step == Step.LIFTING


# --- charge


def test_a_robot_with_a_low_battery_gets_a_charging_place_and_no_work(desk):
    charging = Charging([8, 9], desk.distances, desk.robots, desk.roads, desk.roads)
    charging.policy = Threshold(0.3, 0.8)
    assert not charging.is_simulated
    desk.robots.charge[:] = 0.2, 0.5
    charging.advance(np.array([True, True]), is_wanted=True)
    assert charging.cell_of == {0: 8} and desk.robots.goal.tolist() == [8, NOWHERE]
    assert charging.kept().tolist() == [True, False]


def test_a_closed_charging_place_is_not_given(desk):
    charging = Charging([8], desk.distances, desk.robots, desk.roads, desk.roads)
    charging.policy = Threshold(0.3, 0.8)
    desk.robots.charge[:] = 0.2, 0.5
    desk.roads.closed = np.array([8])
    charging.advance(np.array([True, True]), is_wanted=True)
    assert charging.cell_of == {}


# --- assign


def assignment(desk, kept=(False, False), waits=lambda _transport: "", unfit=None):
    return Assignment(
        desk.book,
        desk.robots,
        desk.units,
        desk.journeys,
        lambda: np.array(kept),
        lambda asked, free: nearest_robots(
            desk.distances, desk.units.cell_of, desk.robots.cell, asked, free
        ),
        waits,
        unfit or UnfitUnits(desk.book, desk.robots),
    )


def test_the_nearest_robot_fetches_the_unit(desk):
    transport = desk.transport()
    assignment(desk).run()
    assert (transport.robot, transport.step) == (1, Step.FETCHING)
    assert desk.robots.goal.tolist() == [NOWHERE, PLACE] and desk.kinds() == [Kind.ASSIGNED]


@pytest.mark.parametrize("column", ["stalled", "lifts_not", "busy", "loaded"])
def test_a_robot_that_can_not_work_gets_no_transport(desk, column):
    transport = desk.transport()
    getattr(desk.robots, column)[1] = True
    assignment(desk).run()
    assert transport.robot == 0


def test_a_robot_that_charges_gets_no_transport(desk):
    transport = desk.transport()
    assignment(desk, kept=(True, True)).run()
    assert transport.robot == NOWHERE


def test_only_a_few_units_of_a_station_are_fetched_ahead():
    desk = Desk(robots=FETCHED + 2)
    desk.units.update({unit: 10 + unit for unit in range(1, 8)}, 0.0, [])
    for unit in range(1, FETCHED + 3):
        desk.transport(unit=unit)
    assignment(desk, kept=[False] * (FETCHED + 2)).run()
    assert len(desk.book.assigned()) == FETCHED and len(desk.book.open) == 2


# --- park and clear


def parking(desk, charging=(), choose_cell=lambda _robot: None):
    return Parking(
        desk.aside, desk.book, desk.robots, desk.completion, charging, choose_cell, desk.roads
    )


def test_a_robot_that_has_ended_a_transport_goes_where_the_policy_says(desk):
    desk.completion.end(desk.transport(*BRINGING))
    parking(desk, choose_cell=lambda robot: PLACE + robot).run()
    assert desk.robots.goal.tolist() == [PLACE, NOWHERE]
    desk.robots.goal[0] = NOWHERE
    parking(desk, choose_cell=lambda robot: PLACE).run()
    assert desk.robots.goal[0] == NOWHERE  # is asked once


def test_a_robot_without_work_gives_its_goal_up_to_one_with_work(desk):
    desk.transport(Step.FETCHING, robot=0)
    desk.robots.goal[:] = PLACE
    parking(desk).run()
    assert desk.robots.goal.tolist() == [PLACE, NOWHERE]


def clearing(desk, charging=()):
    return Clearing(
        desk.aside, desk.distances, desk.book, desk.robots, desk.units, charging, desk.roads
    )


def test_robots_without_work_leave_the_street_for_cells_beneath_units(desk):
    clearing(desk).run()
    assert desk.robots.goal.tolist() == [PLACE, NOWHERE]  # there is one such cell


def test_robots_that_charge_or_stand_aside_stay(desk):
    desk.robots.cell[1] = PLACE + 1
    clearing(desk, charging=[0]).run()
    assert (desk.robots.goal == NOWHERE).all()


# --- reject


@pytest.mark.parametrize("steps", [1, 2, 3])
def test_a_unit_that_its_robot_can_not_carry_goes_to_another_robot_and_not_back(desk, steps):
    transport = desk.transport(*(Step.FETCHING, Step.READY, Step.LIFTING)[:steps], robot=1)
    desk.robots.busy[1] = steps == 3
    unfit = UnfitUnits(desk.book, desk.robots)
    rejection = Rejection(desk.book, desk.robots, unfit, desk.completion)
    rejection.add(2, UNIT, "the unit weighs 99 kg")
    rejection.run()
    assert transport.step == Step.OPEN and not desk.robots.busy[1]
    assignment(desk, unfit=unfit).run()
    assert (transport.robot, transport.step) == (0, Step.FETCHING)


def test_a_unit_that_the_only_free_robot_can_not_carry_waits_and_others_do_not(desk):
    unfit = UnfitUnits(desk.book, desk.robots)
    desk.units.update({UNIT: PLACE, 8: PLACE + 1}, 0.0, [])
    first, second = desk.transport(), desk.transport(unit=8)
    unfit.note(0, UNIT, "too heavy")
    desk.robots.busy[1] = True
    assignment(desk, unfit=unfit).run()
    assert (first.step, second.robot) == (Step.OPEN, 0)


def test_a_robot_is_asked_again_after_a_time(desk):
    unfit = UnfitUnits(desk.book, desk.robots)
    unfit.note(1, UNIT, "too heavy")
    desk.roads.time += ASKS_AGAIN - 1
    assert unfit.robots_of(UNIT) == {1}
    desk.roads.time += 1
    assert unfit.robots_of(UNIT) == frozenset()


def test_a_transport_fails_if_no_robot_can_carry_its_unit(desk):
    transport = desk.transport(Step.FETCHING, robot=1)
    unfit = UnfitUnits(desk.book, desk.robots)
    rejection = Rejection(desk.book, desk.robots, unfit, desk.completion)
    rejection.add(2, UNIT, "too heavy")
    rejection.run()
    assert transport.number in desk.book
    rejection.add(1, UNIT, "too large")
    rejection.run()
    assert transport.number not in desk.book
    text = desk.book.take_events()[-1].text
    assert text == "no robot can carry its unit: kiva1: too large; kiva2: too heavy"
