# SPDX-License-Identifier: Apache-2.0
"""Requests to a fleet are answered alike, and the same events follow, at every moment: by robots
that drive, and by ideal ones.
"""

from functools import partial

import numpy as np
import pytest
from operations_site import site

from kiva_plugin_cpp import World
from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.transports.transport_book import FETCHED, INBOUND
from warehouse_fleet.transports.transports import STAY, Kind, Step
from warehouse_operations.fleets.ideal import IdealFleet

UNIT, STATION = 2, "pick1"
PATIENCE = 600  # [s]
GONE = (False, "there is no transport 1 under way")
BACK = [Kind.RELEASED, Kind.STORED]
# What follows a request to cancel, by the step at which it is made.
CANCELLED = {
    Step.OPEN: [Kind.CANCELLED],
    Step.FETCHING: [Kind.CANCELLED],
    Step.LIFTING: [Kind.CANCELLED, Kind.LIFTED, Kind.STORED],
    Step.BRINGING: [Kind.CANCELLED, Kind.STORED],
    Step.WAITING: [Kind.CANCELLED, *BACK],
    Step.STORING: [Kind.STORED],
    Step.DROPPING: [Kind.STORED],
}
COUNTED = {Step.FETCHING, Step.LIFTING, Step.BRINGING, Step.WAITING}


class Driven:
    """Robots that drive."""

    def __init__(self):
        self._driver = FleetDriver(World.preset("small"))
        self.requests, self.plan = self._driver.transports, self._driver.plan
        self.close = self._driver.close

    def advance(self):
        self._driver.step()
        return self._driver.time


class Ideal:
    """Ideal robots."""

    def __init__(self):
        where = site()
        cell = next(iter(where.units.values()))
        self.requests, self.plan = IdealFleet(where.plan, {1: cell}, where.units), where.plan
        self.close = self.requests.close

    def advance(self):
        self.requests.step_until(self.requests.time + 0.1)
        return self.requests.time


class Bench:
    """A fleet with one transport, and the kinds of the events since they were last asked for."""

    def __init__(self, fleet):
        self._fleet, self.requests, self.plan = fleet, fleet.requests, fleet.plan
        self._kinds = []

    def kinds(self):
        self._kinds += [event.kind for event in self.requests.take_events()]
        kinds, self._kinds = self._kinds, []
        return kinds

    def until(self, holds):
        end = self._fleet.advance() + PATIENCE
        while not holds():
            assert self._fleet.advance() < end, "waited in vain"
            self.check_counts()
            self._kinds += [event.kind for event in self.requests.take_events()]

    def check_counts(self):
        """The book counts what is in it."""
        book = self.requests.book
        steps = [transport.step for transport in book if transport.station == STATION]
        assert book.fetched[STATION] == sum(step in FETCHED for step in steps)
        assert book.inbound[STATION] == sum(step in INBOUND for step in steps)
        for robot, transport in book.of_robot.items():
            assert book.step_of[robot] == transport.step

    def begin(self, step, **request):
        """Asks for a transport, and goes on until it is at a step; releases what arrives on the
        way."""
        answer = self.requests.submit(UNIT, **(request or {"station": STATION}))
        assert answer == (1, True, "")
        while self.step() != step:
            self.until(lambda: self.step() != Step.OPEN)
            if self.step() == Step.WAITING and step > Step.WAITING:
                assert self.requests.release(1) == (True, "")
            if (before := self.step()) != step:
                self.until(partial(self._has_left, before))

    def _has_left(self, step):
        return self.step() != step

    def step(self):
        transport = self.requests.book.get(1)
        return transport.step if transport else None

    def over(self):
        self.until(lambda: 1 not in self.requests.book)


@pytest.fixture(params=[Driven, Ideal])
def bench(request):
    fleet = request.param()
    yield Bench(fleet)
    fleet.close()


@pytest.mark.parametrize("step", CANCELLED)
def test_a_transport_is_cancelled_at_every_moment(bench, step):
    requests = bench.requests
    bench.begin(step)
    bench.kinds()
    assert requests.waiting(STATION) == (step in COUNTED)
    assert requests.cancel(1) == (True, "")
    if step <= Step.READY:
        assert requests.waiting(STATION) == 0
        assert requests.cancel(1) == requests.release(1) == GONE
        assert requests.submit(UNIT, STATION).accepted
        assert bench.kinds() == [*CANCELLED[step], Kind.RECEIVED]
        return
    assert requests.cancel(1) == (True, "")  # once more, which changes nothing
    was_cancelled = step <= Step.WAITING
    said = "was cancelled" if was_cancelled else "has been released already"
    assert requests.release(1) == (False, f"transport 1 {said}")
    text = f"storage unit {UNIT} has transport 1 already"
    assert requests.submit(UNIT, STATION) == (0, False, text)
    bench.over()
    assert bench.kinds() == CANCELLED[step]
    assert requests.cancel(1) == GONE
    assert requests.waiting(STATION) == 0
    assert requests.cell_of_unit[UNIT] >= 0


@pytest.mark.parametrize("step", [Step.OPEN, Step.FETCHING, Step.LIFTING, Step.BRINGING])
def test_only_what_has_arrived_is_released(bench, step):
    bench.begin(step)
    assert bench.requests.release(1) == (False, "transport 1 has not arrived yet")


def test_a_unit_is_released_once(bench):
    bench.begin(Step.WAITING)
    bench.kinds()
    assert bench.requests.release(1) == (True, "")
    assert bench.requests.release(1) == (False, "transport 1 has been released already")
    bench.over()
    assert bench.kinds() == BACK
    assert bench.requests.release(1) == GONE


@pytest.mark.parametrize("step", CANCELLED)
def test_a_station_that_closes_sends_back_what_has_not_arrived(bench, step):
    bench.begin(step)
    bench.kinds()
    bench.requests.set_open(STATION, False)
    if step == Step.WAITING:
        assert bench.kinds() == []
        assert bench.requests.release(1) == (True, "")
    if step > Step.READY:
        bench.over()
    assert bench.kinds() == (BACK if step == Step.WAITING else CANCELLED[step])
    assert bench.requests.submit(UNIT, STATION) == (0, False, f"station {STATION} is closed")


def street(plan):
    """A point in a street, [m]."""
    aside = plan.storage | plan.parking | plan.lane | ~plan.passable
    return plan.point_of(int(np.flatnonzero(~aside)[9]))


def test_a_unit_that_is_to_be_stored_waits_in_a_cell_too(bench):
    x, y = street(bench.plan)
    bench.begin(Step.WAITING, x=x, y=y)
    assert bench.kinds()[-1] == Kind.ARRIVED
    assert bench.requests.release(1) == (True, "")
    bench.over()
    assert bench.kinds() == BACK


def test_a_unit_that_is_to_stay_in_a_cell_is_put_down_at_once(bench):
    x, y = street(bench.plan)
    bench.begin(Step.BRINGING, x=x, y=y, then=STAY)
    text = f"({x:g}, {y:g}) is taken"
    assert bench.requests.submit(UNIT + 1, x=x, y=y, then=STAY) == (0, False, text)
    bench.kinds()
    bench.over()
    assert bench.kinds() == [Kind.ARRIVED, *BACK]
    assert bench.requests.cell_of_unit[UNIT] == bench.plan.cell_of(x, y)
    assert bench.requests.submit(UNIT + 1, x=x, y=y, then=STAY) == (0, False, text)


@pytest.mark.parametrize(
    ("request_", "text"),
    [
        ((10**6, STATION), "there is no storage unit 1000000"),
        ((1, "nowhere"), "there is no station 'nowhere'"),
        ((1,), "neither a station nor a point: (None, None)"),
        ((1, "", float("nan"), 0.0), "neither a station nor a point: (nan, 0.0)"),
        ((1, "", 1e6, 0.0), "no robot can stand at (1e+06, 0)"),
        ((1, STATION, None, None, 7), "then is 7; 0 (STORE) or 1 (STAY) was expected"),
    ],
)
def test_what_can_not_be_is_refused(bench, request_, text):
    assert bench.requests.submit(*request_) == (0, False, text)
    assert bench.kinds() == [] and list(bench.requests.book) == []


def test_a_lane_is_no_cell_to_bring_a_unit_to(bench):
    x, y = bench.plan.point_of(int(bench.plan.stations[0].cells[0]))
    text = f"({x:g}, {y:g}) is in the lane of a station; name the station"
    assert bench.requests.submit(1, x=x, y=y) == (0, False, text)
