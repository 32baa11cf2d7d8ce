# SPDX-License-Identifier: Apache-2.0
"""The visits of units that a shift requests from the fleet, and the units that are free for one."""

import itertools
import math
from collections import Counter
from collections.abc import Collection
from typing import Protocol

from warehouse_fleet.transports.transports import ENDS, Kind, TransportEvent
from warehouse_operations.shift.context import Context
from warehouse_operations.shift.notices import Notices
from warehouse_operations.stock.protocols import Requests
from warehouse_operations.stock.stations import Visit, WorkStation
from warehouse_operations.stock.units_by_id import UnitSet
from warehouse_operations.stock.whereabouts import Whereabouts

HOLD = 10.0  # pause before a unit is requested again after a failed or refused transport [s]


class Part(Protocol):
    """A part of a shift that asks for visits."""

    def on_arrival(self, visit: Visit) -> None:
        """Begins the work at a unit that has arrived, or lets it leave."""

    def drop_visit(self, visit: Visit) -> None:
        """Gives up the work of a visit: its unit does not come, or leaves early."""

    def on_unit_free(self, unit: int) -> None:
        """Finds work for a unit that may be requested again."""


class Visits:
    """The visits of units to stations that are under way.

    free_units: the ids of units that stand in storage and may be requested. most: most units at a
    station or on their way to it.
    """

    def __init__(
        self,
        context: Context,
        transports: Requests,
        floor: Whereabouts,
        notices: Notices,
        most: int,
    ) -> None:
        self._context, self._transports = context, transports
        self._floor, self._notices, self.most = floor, notices, most
        self.free_units = UnitSet(floor.units)
        self._parts: dict[bool, Part] = {}  # by whether their visits replenish
        self._absent: set[int] = set()  # units that are not in the warehouse any more
        self._by_transport: dict[int, Visit] = {}
        self._away: Counter[int] = Counter()  # visits of each unit
        self._ids = itertools.count(1)

    def register(self, part: Part, replenishes: bool) -> None:
        """Has a Part follow the visits that replenish, or those for picking."""
        self._parts[replenishes] = part

    def request(self, unit: int, station: WorkStation, replenishes: bool = False) -> Visit | None:
        """Asks the fleet for a unit: for picking, or for bundles if it `replenishes`.

        Returns None where the fleet refuses: the unit is held for HOLD.
        """
        clock = self._context.clock
        answer = self._transports.submit(unit, station.name)
        self.free_units.discard(unit)
        if not answer.accepted:
            clock.schedule(clock.now + HOLD, self.free, unit)
            return None
        visit = Visit(next(self._ids), answer.transport_id, unit, station, clock.now)
        visit.replenishes = replenishes
        self._by_transport[answer.transport_id] = visit
        self._away[unit] += 1
        station.add_visit(visit)
        self._context.journal.visit(visit)
        return visit

    @property
    def under_way(self) -> Collection[Visit]:
        """The visits that are not over."""
        return self._by_transport.values()

    def restore(self, visit: Visit) -> None:
        """Adds a visit of an earlier run that is under way."""
        self._ids = itertools.count(visit.visit_id + 1)
        self.free_units.discard(visit.unit)
        self._floor.cells.pop(visit.unit, None)
        self._by_transport[visit.transport_id] = visit
        self._away[visit.unit] += 1
        visit.station.add_visit(visit)

    def release(self, visit: Visit) -> None:
        """Lets the unit leave the station."""
        visit.station.release(visit, self._context.clock.now)
        self._transports.release(visit.transport_id)
        self._context.journal.visit(visit)

    def cancel(self, visit: Visit) -> None:
        """Cancels the transport of a unit on its way."""
        visit.station.release(visit, self._context.clock.now)
        self._transports.cancel(visit.transport_id)

    def update_units(self, units: set[int]) -> None:
        """Takes in the ids of all units of the warehouse; missing ones are not asked for."""
        gone = self._context.inventory.of_unit.keys() - units
        for unit in sorted(gone - self._absent):
            self._withdraw(unit)
            self._notices.add(_gone(unit))
        back, self._absent = self._absent - gone, gone
        for unit in sorted(back):
            self._notices.drop(_gone(unit))
            self.free(unit)

    def _withdraw(self, unit: int) -> None:
        """Ends the visits of a unit; it is not asked for until free() is called."""
        self.free_units.discard(unit)
        for visit in [v for v in self._by_transport.values() if v.unit == unit]:
            self._part_of(visit).drop_visit(visit)
            if visit.here:
                self.release(visit)
            elif visit.released is None:
                self.cancel(visit)

    def free(self, unit: int) -> None:
        """Lets a unit be asked for, unless it is away or absent."""
        if unit not in self._absent and not self._away[unit]:
            self.free_units.add(unit)
            self.offer(unit)

    def offer(self, unit: int) -> None:
        """Lets the parts of the shift find work for a unit, if it may be requested."""
        if unit in self.free_units:
            for part in self._parts.values():
                part.on_unit_free(unit)

    def on_event(self, event: TransportEvent) -> None:
        """Updates the visit of a TransportEvent, if there is one."""
        visit = self._by_transport.get(event.transport_id)
        if not visit:
            return
        self._context.update_hash(
            "transport", event.transport_id, int(event.kind), event.kiva_id, event.shelf_id
        )
        if event.kind == Kind.CANCELLED:
            visit.outcome = "cancelled"
            if visit.lifted is None:
                self._end(visit, event)
        elif event.kind == Kind.RECEIVED:  # again: its unit was put back before a closed zone
            visit.lifted = None
        elif event.kind == Kind.LIFTED:
            self._lift(visit, event)
        elif event.kind == Kind.ARRIVED:
            self._arrive(visit, event)
        elif event.kind in ENDS:
            self._end(visit, event)

    def _lift(self, visit: Visit, event: TransportEvent) -> None:
        visit.lifted = event.stamp
        way = self._floor.seconds_to(visit.station.name, visit.unit)  # without the queue there
        if not visit.replenishes and math.isfinite(way):
            visit.station.lead_time.note(event.stamp - visit.requested + way)
        self._floor.cells.pop(visit.unit, None)
        self._context.journal.visit(visit)

    def _arrive(self, visit: Visit, event: TransportEvent) -> None:
        visit.arrived = event.stamp
        self._context.journal.visit(visit)
        if visit.released is None:
            self._part_of(visit).on_arrival(visit)
        else:  # cancelled too late
            self._transports.release(visit.transport_id)

    def _end(self, visit: Visit, event: TransportEvent) -> None:
        clock = self._context.clock
        del self._by_transport[visit.transport_id]
        self._away[visit.unit] -= 1
        self._part_of(visit).drop_visit(visit)
        visit.ended, visit.outcome = event.stamp, visit.outcome or event.kind.name.lower()
        if visit.released is None:
            visit.station.release(visit, event.stamp)
        visit.station.end_visit(visit)
        self._context.journal.visit(visit)
        self._context.tally.visited(visit)
        visit.station.visits += visit.arrived is not None
        if event.kind == Kind.FAILED:
            clock.schedule(clock.now + HOLD, self.free, visit.unit)
        else:
            self.free(visit.unit)

    def _part_of(self, visit: Visit) -> Part:
        """Returns the part of the shift that asked for a visit."""
        return self._parts[visit.replenishes]


def _gone(unit: int) -> str:
    return f"storage unit {unit} is gone: its stock is not asked for"
