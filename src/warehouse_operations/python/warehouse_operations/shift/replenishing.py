# SPDX-License-Identifier: Apache-2.0
"""Replenishing: queues bundles that arrive, chooses bins for them and fetches their units."""

from collections import deque
from collections.abc import Sequence
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from warehouse_operations.stock.inventory import Bin
from warehouse_operations.stock.message_enums import Mode
from warehouse_operations.stock.orders import Bundle
from warehouse_operations.stock.stations import Visit, WorkStation

if TYPE_CHECKING:
    from warehouse_operations.shift.shift import Shift

PERIOD = 10.0  # between two looks at what is to be ordered [s]
RETRY = 1.0  # after the fleet refused a unit [s]
LOOK_AHEAD = 30  # waiting bundles that are tried for a place


class Replenishing:
    """The part of a Shift that works at its replenishing stations."""

    def __init__(self, shift: "Shift", stations: Sequence[WorkStation]) -> None:
        self.shift, self.stations = shift, stations
        self.bundles: dict[int, Bundle] = {}  # those without a bin yet, by id
        self.ordered = 0  # pieces in them
        self.ordered_of: dict[str, int] = {}  # pieces in them, by SKU
        self.changed: set[str] = set()  # SKUs of which that has changed
        self.sold_out: set[str] = set()  # SKUs of which no more come
        self._count = 0
        self._look = True

    def order(self, sku: str, quantity: int) -> None:
        """Queues a bundle that has arrived for replenishment; none comes of what is sold out."""
        if sku in self.sold_out:
            return
        self._count += 1
        self.bundles[self._count] = Bundle(self._count, sku, quantity, self.shift.now)
        self._ordered(sku, quantity)
        self._look = True

    def refill(self) -> None:
        """Orders the bundles that the policy asks for; called every PERIOD."""
        if self.stations:
            for sku, quantity in self.shift.policies.replenishment.bundles(self.shift.view):
                self.order(sku, quantity)

    def on_unit_free(self) -> None:
        """Lets waiting bundles look for a place again."""
        self._look = True

    def work(self) -> None:
        """Fetches units with room for the bundles that wait."""
        if not self._look:
            return
        self._look = False
        limit = -(-self.shift.units_per_station // 2)  # their units have more work with them
        coming = {s: n for s in self.stations if s.is_open and (n := _coming(s)) < limit}
        while self.bundles and coming:
            station = min(coming, key=coming.__getitem__)
            if not self._fetch(station):
                return
            coming[station] += 1
            if coming[station] >= limit:
                del coming[station]

    def _fetch(self, station: WorkStation) -> bool:
        for bundle in islice(self.bundles.values(), LOOK_AHEAD):
            candidates = self._within_reach(station, self._candidates(bundle))
            if candidates:
                one = self.shift.policies.bins.choose(bundle, candidates, self.shift.view)
                visit = self.shift.visits.request(one.unit, station, replenishes=True)
                if visit:
                    self._place(bundle, one, visit)
                    self._fill_up(visit)
                    return True
                self.shift.events.schedule(self.shift.now + RETRY, self._retry)
                return False
        return False

    def _retry(self, _: None) -> None:
        self._look = True

    def _candidates(self, bundle: Bundle) -> list[Bin]:
        """Returns the bins on free units that have room for a bundle."""
        inventory, free = self.shift.inventory, self.shift.free_units
        both = (inventory.with_sku(bundle.sku), inventory.empty.values())
        return [
            one
            for bins in both
            for one in bins
            if one.unit in free and inventory.takes(one, bundle.sku, bundle.quantity)
        ]

    def _within_reach(self, station: WorkStation, bins: list[Bin]) -> list[Bin]:
        """Returns those of some bins whose units are not too far from a station."""
        floor = self.shift.floor
        if not bins or np.isinf(floor.reach):
            return bins
        seconds = floor.seconds_to_all(station.name, np.array([one.unit for one in bins]))
        is_near = seconds <= seconds.min() + floor.reach
        return [one for one, near in zip(bins, is_near.tolist()) if near]

    def _fill_up(self, visit: Visit) -> None:
        """Adds other waiting bundles that have a place on the same unit to its visit."""
        inventory = self.shift.inventory
        bins = inventory.of_unit[visit.unit]
        for bundle in list(self.bundles.values()):
            places = [one for one in bins if inventory.takes(one, bundle.sku, bundle.quantity)]
            same = [one for one in places if one.sku == bundle.sku]
            if same:
                self._place(bundle, min(same, key=lambda one: one.room), visit)
            elif places and self.shift.view.stock_of(bundle.sku) < bundle.quantity:
                self._place(bundle, places[0], visit)

    def _place(self, bundle: Bundle, one: Bin, visit: Visit) -> None:
        del self.bundles[bundle.bundle_id]
        self._ordered(bundle.sku, -bundle.quantity)
        bundle.bin, bundle.sequence = one, self.shift.tasks.number()
        self.shift.inventory.expect(one, bundle.sku, bundle.quantity)
        visit.puts.append(bundle)

    def _ordered(self, sku: str, quantity: int) -> None:
        self.ordered += quantity
        self.ordered_of[sku] = self.ordered_of.get(sku, 0) + quantity
        self.changed.add(sku)

    # At the station.

    def on_arrival(self, visit: Visit) -> None:
        """Starts putting bundles into a unit that has arrived, or lets it leave."""
        self.next_bundle(visit.station)
        self.leave_if_done(visit.station)

    def next_bundle(self, station: WorkStation) -> None:
        """Starts putting in the next bundle, if the station is free and a unit is there."""
        visit = station.here
        if station.at_work or not visit or not visit.puts or station.mode == Mode.MANUAL:
            return
        station.at_work = 1
        now = self.shift.now
        self.shift.events.schedule(
            now + station.seconds_a_bundle, self._put_in, (station, visit, now)
        )

    def _put_in(self, argument: tuple[WorkStation, Visit, float]) -> None:
        station, visit, began = argument
        station.at_work = 0
        station.busy_s += self.shift.now - began
        if visit.here and visit.puts:
            self.put(visit, visit.puts[0])
        self.shift.next_work(station)
        self.leave_if_done(station)

    def put(self, visit: Visit, bundle: Bundle) -> None:
        """Puts a bundle into its bin."""
        visit.puts.remove(bundle)
        self.shift.inventory.put(
            bundle.bin, bundle.sku, bundle.quantity, station=visit.station, visit=visit
        )
        visit.pieces += bundle.quantity
        station = visit.station
        station.pieces += bundle.quantity
        self.shift.tally.stored(self.shift.now, bundle)

    def drop_visit(self, visit: Visit) -> None:
        """Queues the bundles of a visit again, whose unit does not come or leaves early."""
        for bundle in visit.puts:
            self._return(bundle)
        visit.puts = deque()

    def drop_bin(self, one: Bin) -> None:
        """Queues the bundles again that were meant for a bin."""
        for visit in [v for s in self.stations for v in s.inbound.values() if v.unit == one.unit]:
            dropped = [bundle for bundle in visit.puts if bundle.bin is one]
            for bundle in dropped:
                visit.puts.remove(bundle)
                self._return(bundle)
            if dropped:
                self.leave_if_done(visit.station)

    def _return(self, bundle: Bundle) -> None:
        self.shift.inventory.unexpect(bundle.bin, bundle.sku, bundle.quantity)
        bundle.bin = None
        self.bundles[bundle.bundle_id] = bundle
        self._ordered(bundle.sku, bundle.quantity)
        self._look = True

    def open(self, station: WorkStation) -> None:
        """Starts the work of a station that was opened, or whose mode was set."""
        self.on_unit_free()
        self.next_bundle(station)

    def close(self, station: WorkStation) -> None:
        """Queues the bundles of a station again and sends its units away."""
        for visit in station.coming_for(replenishes=True):
            self.drop_visit(visit)
            if not visit.here:
                self.shift.visits.cancel(visit)
        self.leave_if_done(station)

    def leave_if_done(self, station: WorkStation) -> None:
        """Releases a unit with nothing left to put in."""
        visit = station.here
        if visit and visit.replenishes and not visit.puts:
            self.shift.visits.release(visit)
            self._look = True
            self.next_bundle(station)


def _coming(station: WorkStation) -> int:
    return len(station.coming_for(replenishes=True))
