# SPDX-License-Identifier: Apache-2.0
"""What is asked of a forecast, checked before anything starts."""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

from warehouse_operations.fleets.availability import Availability
from warehouse_operations.forecast.ahead import Task, times_of
from warehouse_operations.forecast.fork import Fork
from warehouse_operations.runs.event_file import Event, EventError, most_added, of_line
from warehouse_operations.runs.names import Names
from warehouse_operations.shift.shift import Shift
from warehouse_operations.stock.demand import FromFile
from warehouse_operations.stock.site import Site

DAY = 24 * 60.0  # [min]
MOST_RUNS = 1000
MOST_CHANGES = 50
LONGEST = 200  # a change [characters]


class ForecastError(Exception):
    """Raised for a forecast that can't be made; says why."""


@dataclass(frozen=True)
class Request:
    """A forecast: how far ahead [min], how many runs (0: as many as time allows), with which
    changes, an event in a line each. physics: with simulated robots in place of ideal ones."""

    minutes: float = 60.0
    runs: int = 0
    changes: tuple[str, ...] = ()
    seed: int = 1
    physics: bool = False

    def check(self) -> None:
        """Raises ForecastError for numbers that can't be meant."""
        if not (math.isfinite(self.minutes) and 0 < self.minutes <= DAY):
            raise ForecastError(
                f"minutes is {self.minutes:g}; above 0, up to {DAY:g} (a day), was expected"
            )
        if not 0 <= self.runs <= MOST_RUNS:
            raise ForecastError(f"runs is {self.runs}; 0 (by time) to {MOST_RUNS} was expected")
        if len(self.changes) > MOST_CHANGES:
            raise ForecastError(
                f"{len(self.changes)} changes; {MOST_CHANGES} or fewer were expected"
            )
        for line in self.changes:
            if len(line) > LONGEST or not line.isprintable():
                raise ForecastError(
                    f"a change is {line[:20]!r}…; a line of up to {LONGEST} characters was expected"
                )

    def events(self, names: Names, since_begin: float) -> tuple[Event, ...]:
        """Returns the events of its changes. since_begin: how long the shift runs [s]. Raises
        ForecastError for one that can't happen, or not within."""
        events = []
        for line in self.changes:
            try:
                event = of_line(line, since_begin)
                names.check(event)
            except EventError as error:
                raise ForecastError(str(error)) from error
            if event.at < since_begin:
                raise ForecastError(f"'{line}' is over; +0 is now")
            if event.at > since_begin + 60 * self.minutes:
                raise ForecastError(f"'{line}' comes after the {self.minutes:g} minutes")
            events.append(event)
        events.sort(key=lambda event: event.at)
        _check_robots(events, len(names.robots))
        return tuple(events)


def tasks_of(
    request: Request,
    site: Site,
    shift: Shift,
    fork: Fork,
    availability: Availability | None = None,
    elsewhere: Collection[str] = (),
) -> list[Task]:
    """Returns the Task of a request; with changes two: as it is, and with them. elsewhere: see
    Names. Raises ForecastError before anything starts."""
    request.check()
    names = replace(names_of(site, shift), elsewhere=elsewhere, ideal=not request.physics)
    events = request.events(names, fork.time - fork.began)
    if request.physics:
        check_world(fork, events)
    coming = any(event.kind == "orders" for event in events)
    if not (shift.orders or comes_more(shift) or fork.recent or coming):
        raise ForecastError("there is nothing to forecast: no order is open, and none is to come")
    times, more = times_of(fork, request.minutes), availability or Availability()
    sets: Sequence[tuple[Event, ...]] = [(), events] if events else [()]
    return [Task(site, fork, times, each, more, request.seed, request.physics) for each in sets]


def check_world(fork: Fork, events: Sequence[Event]) -> None:
    """Raises ForecastError where simulated robots can't go on from a fork."""
    if not fork.world:
        raise ForecastError(
            "simulated robots need a checkpoint of their world, which this shift does not have:"
            " ideal ones were expected"
        )
    if most_added(events):
        raise ForecastError(
            "simulated robots are those of the checkpoint: ideal ones were expected for robots +"
        )


def _check_robots(events: Sequence[Event], count: int) -> None:
    """Raises ForecastError where more robots are taken away than there are then."""
    for event in events:
        if event.kind == "robots":
            if count + event.value < 0:
                raise ForecastError(f"robots is {event.value:+d}; there are {count} then")
            count += event.value


def names_of(site: Site, shift: Shift) -> Names:
    """Returns what changes may name."""
    stations = [station.name for station in shift.stations]
    orders = {name for order in shift.orders.values() for name in order.names}
    return Names(stations, site.robots, shift.assortment.skus, True, orders)


def comes_more(shift: Shift) -> bool:
    """Returns whether orders are to come."""
    demand = shift.demand
    return bool(demand) and not (isinstance(demand, FromFile) and demand.next_time() == math.inf)
