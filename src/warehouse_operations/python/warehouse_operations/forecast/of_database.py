# SPDX-License-Identifier: Apache-2.0
"""The fork of a shift that its database remembers, at any time of it.

A database holds orders, stock, promises and visits. What it does not hold is taken as usual: robots
stand where the layout has them or are where a visit says, drives under way take their usual time,
units stand where the layout has them, stations are open and work by themselves, and bundles that
were ordered are ordered again.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from warehouse_fleet.transports.transport_book import BRINGING, FETCHING, OPEN, STORING, WAITING
from warehouse_operations.fleets.fleet_now import FleetNow, RobotNow, TransportNow
from warehouse_operations.forecast.fork import Fork, of_shift
from warehouse_operations.forecast.request import ForecastError
from warehouse_operations.policies import Policies
from warehouse_operations.shift.shift import Shift
from warehouse_operations.stock.demand import FromFile, make_demand
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.site import Site
from warehouse_operations.stock.stations import Visit
from warehouse_operations.stock.stored_warehouse import Stored
from warehouse_operations.stock.whereabouts import Whereabouts
from warehouse_operations.store.moment import Moment
from warehouse_operations.store.returning import changes

SOON = 2.0  # least time that a drive still takes [s]


@dataclass(frozen=True)
class Remembered:
    """The shift of a Moment, and its fork."""

    shift: Shift
    fork: Fork


class _NoFleet:
    """Stands in for a fleet while a shift is put together; a fork leaves it out."""

    def submit(self, *_: Any, **__: Any) -> Any:
        """Refuses: the shift is not at work."""
        raise ForecastError("a remembered shift does not work")


def remember(moment: Moment, site: Site, url: str, orders: str | None = None) -> Remembered:
    """Returns the shift of a Moment at its Site. orders: an orders text in place of the run's.

    Raises SiteError for the database of another warehouse, DemandError, PolicyError.
    """
    former = Stored(moment.assortment, moment.bins, {}, 0, [], moment.last_order, moment.layout)
    gone = {bin_.bin_id for bin_ in changes(site, former, url).gone}
    bins = [bin_ for bin_ in moment.bins if bin_.bin_id not in gone]
    capacity = sum(bin_.capacity for bin_ in bins)
    shift = Shift(
        _NoFleet(),  # type: ignore[arg-type]
        moment.assortment,
        bins,
        floor=Whereabouts(site.plan, site.robots, site.units),
        policies=Policies(moment.policies),
        demand=_demand(moment, site, orders or moment.orders_text, capacity),
        settings=site.settings,
        now=moment.began,
    )
    shift.context.clock.now = moment.time
    shift.tally.ways_back.extend(moment.ways_back)
    in_hand = [order for order in moment.orders if order.done]
    shift.order_book.resume([o for o in moment.orders if not o.done], moment.last_order)
    for order in in_hand:  # the last piece is on its way into the tote
        shift.orders[order.order_id] = order
        shift.backlog.add(order)
    visits = _restore(shift, moment)
    transports = list(_transports(moment, site, visits))
    busy = {transport.kiva_id: transport for transport in transports}
    robots = {
        kiva_id: RobotNow(_cell_of(busy.get(kiva_id), cell))
        for kiva_id, cell in site.robots.items()
    }
    away = {visit.unit for visit in visits if visit.lifted is not None}
    units = {unit: cell for unit, cell in site.units.items() if unit not in away and cell >= 0}
    fleet = FleetNow(moment.time, robots, units, transports)
    recent = moment.recent if (orders or moment.orders_text) == "none" else ()
    return Remembered(shift, of_shift(shift, fleet, recent))


def _demand(moment: Moment, site: Site, text: str, capacity: int) -> Any:
    """Returns what orders come, as the orders text says."""
    rng = np.random.default_rng(1)
    picks = [station.kind == "PICK" for station in site.plan.stations]
    count = sum(picks), len(picks) - sum(picks)
    demand = make_demand(text, moment.assortment, count, rng, moment.began, capacity)
    if isinstance(demand, FromFile):
        demand.skip_to(moment.time)
    return demand


def _restore(shift: Shift, moment: Moment) -> list[Visit]:
    """Restores visits under way and the orders that stations have; returns the visits."""
    visits = []
    for then in moment.visits:
        station = shift.station(then.station)
        visit = Visit(then.visit_id, then.transport_id, then.unit, station, then.requested)
        visit.lifted, visit.arrived, visit.released = then.lifted, then.arrived, then.released
        visit.pieces, visit.stored = then.pieces, True
        visit.replenishes = then.replenishes or not station.picks
        shift.visits.restore(visit)
        visits.append(visit)
    by_id: dict[int, Order] = dict(shift.orders)
    for order_id, name in moment.assigned.items():
        station, order = shift.station(name), by_id[order_id]
        shift.picking.restore(station, order)
        if order.done:
            rest = (station.seconds_a_piece - station.pick_seconds) / 2
            shift.context.clock.schedule(moment.time + rest, shift.picking.complete, station)
    for visit in visits:
        if visit.here:
            part = shift.replenishing if visit.replenishes else shift.picking
            shift.context.clock.schedule(moment.time, part.on_arrival, visit)
    return visits


def _transports(moment: Moment, site: Site, visits: Sequence[Visit]) -> Iterator[TransportNow]:
    """Yields the transports of visits; those that have a robot for certain get theirs first."""
    service = {s.name: int(s.cells[s.service]) for s in site.plan.stations}
    robots = iter(sorted(site.robots))
    first_way, to_station, back = moment.ways
    for visit in sorted(visits, key=lambda visit: (visit.lifted is None, visit.visit_id)):
        kiva_id = next(robots, 0)
        step, since, usual = _step(visit, (first_way, to_station, back))
        transport = TransportNow(
            visit.transport_id,
            visit.unit,
            visit.station.name,
            service[visit.station.name],
            step if kiva_id else OPEN,
            kiva_id,
            since=since,
            left=max(usual - (moment.time - since), SOON) if usual else math.nan,
        )
        yield transport


def _step(visit: Visit, ways: tuple[float, float, float]) -> tuple[Any, float, float]:
    """Returns the step of a visit, since when it is at it, and how long that usually takes [s]; 0:
    until it is released."""
    if visit.lifted is None:
        return FETCHING, visit.requested, ways[0]
    if visit.arrived is None:
        return BRINGING, visit.lifted, ways[1]
    if visit.released is None:
        return WAITING, visit.arrived, 0.0
    return STORING, visit.released, ways[2]


def _cell_of(transport: TransportNow | None, cell: int) -> int:
    """Returns where a robot is: with its unit at the station, or on a way from or to it."""
    return transport.cell if transport and transport.step in (WAITING, STORING) else cell
