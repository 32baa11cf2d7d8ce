# SPDX-License-Identifier: Apache-2.0
"""Units that a shift asks the fleet for, and those that it may ask for."""

import itertools
from collections import Counter
from typing import TYPE_CHECKING

from warehouse_fleet.transports.transports import ENDS, Kind, TransportEvent
from warehouse_operations.stock.stations import Visit, WorkStation
from warehouse_operations.stock.units_by_id import UnitSet

if TYPE_CHECKING:
    from warehouse_operations.shift.shift import Shift

HOLD = 10.0  # a unit is not asked for this long after its transport failed or was refused [s]


class Visits:
    """The visits of units to stations that are under way.

    free_units: the ids of units that stand in storage and may be asked for.
    """

    def __init__(self, shift: "Shift") -> None:
        self._shift = shift
        self.free_units = UnitSet(shift.floor.units)
        self._absent: set[int] = set()  # units that are not in the warehouse any more
        self._by_transport: dict[int, Visit] = {}
        self._away: Counter[int] = Counter()  # visits of each unit
        self._ids = itertools.count(1)

    def request(self, unit: int, station: WorkStation, replenishes: bool = False) -> Visit | None:
        """Asks the fleet for a unit: for picking, or for bundles if it `replenishes`.

        Returns None where the fleet refuses: the unit is held for HOLD.
        """
        shift = self._shift
        answer = shift.transports.submit(unit, station.name)
        self.free_units.discard(unit)
        if not answer.accepted:
            shift.events.schedule(shift.now + HOLD, self.free, unit)
            return None
        visit = Visit(next(self._ids), answer.transport_id, unit, station, shift.now)
        visit.replenishes = replenishes
        self._by_transport[answer.transport_id] = visit
        self._away[unit] += 1
        station.inbound[visit.visit_id] = visit
        shift.journal.visit(visit)
        return visit

    def release(self, visit: Visit) -> None:
        """Lets the unit leave the station."""
        visit.released = self._shift.now
        self._shift.transports.release(visit.transport_id)
        self._shift.journal.visit(visit)

    def cancel(self, visit: Visit) -> None:
        """Cancels the transport of a unit on its way."""
        visit.released = self._shift.now
        self._shift.transports.cancel(visit.transport_id)

    def update_units(self, units: set[int]) -> None:
        """Takes in the ids of all units of the warehouse; missing ones are not asked for."""
        gone = self._shift.inventory.of_unit.keys() - units
        for unit in sorted(gone - self._absent):
            self.withdraw(unit)
            self._shift.notices.add(_gone(unit))
        back, self._absent = self._absent - gone, gone
        for unit in sorted(back):
            self._shift.notices.drop(_gone(unit))
            self.free(unit)

    def withdraw(self, unit: int) -> None:
        """Ends the visits of a unit; it is not asked for until free() is called."""
        self.free_units.discard(unit)
        for visit in [v for v in self._by_transport.values() if v.unit == unit]:
            self._shift.part_of(visit).drop_visit(visit)
            if visit.here:
                self.release(visit)
            elif visit.released is None:
                self.cancel(visit)

    def free(self, unit: int) -> None:
        """Lets a unit be asked for, unless it is away, absent or out of service."""
        blocked, absent = self._shift.inventory.blocked, self._absent
        if unit not in blocked and unit not in absent and not self._away[unit]:
            self.free_units.add(unit)
            self._shift.picking.on_unit_free(unit)
            self._shift.replenishing.on_unit_free()

    def on_event(self, event: TransportEvent) -> None:
        """Brings the visit up to date that a TransportEvent belongs to, if any."""
        visit, shift = self._by_transport.get(event.transport_id), self._shift
        if not visit:
            return
        shift.update_hash(
            "transport", event.transport_id, int(event.kind), event.kiva_id, event.shelf_id
        )
        if event.kind == Kind.CANCELLED:
            visit.outcome = "cancelled"
            if visit.lifted is None:
                self._end(visit, event)
        elif event.kind == Kind.LIFTED:
            visit.lifted = event.stamp
            shift.floor.cells.pop(visit.unit, None)
            shift.journal.visit(visit)
        elif event.kind == Kind.ARRIVED:
            self._arrive(visit, event)
        elif event.kind in ENDS:
            self._end(visit, event)

    def _arrive(self, visit: Visit, event: TransportEvent) -> None:
        visit.arrived = event.stamp
        self._shift.journal.visit(visit)
        if visit.released is None:
            self._shift.part_of(visit).on_arrival(visit)
        else:  # cancelled too late
            self._shift.transports.release(visit.transport_id)

    def _end(self, visit: Visit, event: TransportEvent) -> None:
        shift = self._shift
        del self._by_transport[visit.transport_id]
        self._away[visit.unit] -= 1
        shift.part_of(visit).drop_visit(visit)
        visit.ended, visit.outcome = event.stamp, visit.outcome or event.kind.name.lower()
        visit.released = event.stamp if visit.released is None else visit.released
        del visit.station.inbound[visit.visit_id]
        shift.journal.visit(visit)
        shift.tally.visited(visit)
        visit.station.visits += visit.arrived is not None
        if event.kind == Kind.FAILED:
            shift.events.schedule(shift.now + HOLD, self.free, visit.unit)
        else:
            self.free(visit.unit)


def _gone(unit: int) -> str:
    return f"storage unit {unit} is gone: its stock is not asked for"
