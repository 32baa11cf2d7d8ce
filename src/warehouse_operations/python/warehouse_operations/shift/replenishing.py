# SPDX-License-Identifier: Apache-2.0
"""Replenishing: queues bundles that arrive, chooses bins for them and fetches their units."""

from collections import deque
from collections.abc import Collection, Sequence
from itertools import islice

import numpy as np

from warehouse_layout.message_enums import StationMode
from warehouse_operations.policies import Policies
from warehouse_operations.policies.view import View
from warehouse_operations.shift import batches
from warehouse_operations.shift.context import Context
from warehouse_operations.shift.task_reports import TaskNumbers
from warehouse_operations.shift.visits import Visits
from warehouse_operations.stock.goods_in import GoodsIn
from warehouse_operations.stock.inventory import Bin
from warehouse_operations.stock.orders import Bundle
from warehouse_operations.stock.stations import Visit, WorkStation

PERIOD = 10.0  # between two calls of the policy that orders bundles [s]
RETRY = 1.0  # after the fleet refused a unit [s]
LOOK_AHEAD = 30  # waiting bundles that are tried for a place
PATIENCE = 14400.0  # for which a bundle waits for others [s]
PAUSE = 10.0  # after a look at bundles that are too few: it costs time for each of them [s]


class Replenishing:
    """The work at replenishing stations: choosing bins, fetching units, putting bundles in."""

    def __init__(
        self,
        context: Context,
        stations: Sequence[WorkStation],
        *,
        policies: Policies,
        view: View,
        goods_in: GoodsIn,
        visits: Visits,
        task_numbers: TaskNumbers,
    ) -> None:
        self._context, self._clock, self.stations = context, context.clock, stations
        self._inventory, self._policies, self._view = context.inventory, policies, view
        self._goods_in, self._visits, self._task_numbers = goods_in, visits, task_numbers
        self.sold_out: set[str] = set()  # SKUs of which no more come
        self._look, self._next_look = True, 0.0
        self._came: list[Bundle] = []  # bundles that no visit under way was tried for
        visits.register(self, replenishes=True)
        for station in stations:
            station.on_hands_free.append(self.next_bundle)

    def order(self, sku: str, quantity: int) -> None:
        """Queues a bundle that has arrived; drops it if its SKU is sold out."""
        if sku in self.sold_out:
            return
        self._came.append(self._goods_in.order(sku, quantity, self._clock.now))
        self._look = True

    def refill(self) -> None:
        """Orders the bundles that the policy asks for; called every PERIOD."""
        if self.stations:
            for sku, quantity in self._policies.replenishment.bundles(self._view):
                self.order(sku, quantity)

    def on_unit_free(self, _unit: int) -> None:
        """Lets waiting bundles look for a place again."""
        self._look = True

    def work(self) -> None:
        """Fetches units with room for the bundles that wait."""
        if not self._look or self._clock.now < self._next_look:
            return
        self._look = False
        self._take_along()
        if not self._goods_in.bundles:
            return
        limit = -(-self._visits.most // 2)  # few visits, each with many bundles
        coming = {s: s.refills_coming for s in self.stations if s.is_open}
        coming = {station: count for station, count in coming.items() if count < limit}
        while self._goods_in.bundles and coming:
            station = min(coming, key=coming.__getitem__)
            if not self._fetch(station):
                return
            coming[station] += 1
            if coming[station] >= limit:
                del coming[station]

    def _fetch(self, station: WorkStation) -> bool:
        """Fetches a unit once the number of waiting bundles that fit on it satisfies the policy;
        returns whether one comes."""
        bundles, units = self._goods_in.bundles.values(), self._visits.free_units
        least = self._policies.batches.least(self._view)
        if least <= 1 and not self._fills:
            return self._fetch_one(station, [*islice(bundles, LOOK_AHEAD)], units)
        size_of = batches.sizes(self._inventory, units, bundles)
        near = self._within_reach(station, [*size_of])
        largest = max((size_of[unit] for unit in near), default=0)
        if largest < least:
            self._next_look = self._clock.now + PAUSE
            return self._fetch_one(station, self._urgent()[:LOOK_AHEAD], units)
        best = {unit for unit in near if size_of[unit] == largest}
        return self._fetch_one(station, self._by_urgency(), best)

    def _by_urgency(self) -> list[Bundle]:
        """Returns the bundles that wait: first those that orders lack, or that have waited for
        PATIENCE."""
        urgent = {bundle.bundle_id for bundle in self._urgent()}
        bundles = self._goods_in.bundles
        return [bundles[i] for i in sorted(bundles, key=lambda i: i not in urgent)]

    @property
    def _fills(self) -> bool:
        return getattr(self._policies.batches, "fills", False)

    def _urgent(self) -> list[Bundle]:
        """Returns the bundles that orders lack, or that have waited for PATIENCE."""
        lacking = self._view.lacking()
        came = self._clock.now - PATIENCE
        return [b for b in self._goods_in.bundles.values() if b.sku in lacking or b.created <= came]

    def _fetch_one(
        self, station: WorkStation, bundles: Collection[Bundle], units: Collection[int]
    ) -> bool:
        """Fetches one of some units for the first of some bundles that has a place there."""
        for bundle in bundles:
            candidates = self._candidates(station, bundle, units)
            if candidates:
                bin_ = self._policies.bins.choose(bundle, candidates, self._view)
                visit = self._visits.request(bin_.unit, station, replenishes=True)
                if visit:
                    self._place(bundle, bin_, visit)
                    self._fill_up(visit)
                    return True
                self._clock.schedule(self._clock.now + RETRY, self._retry)
                return False
        return False

    def _retry(self, _: None) -> None:
        self._look = True

    def _candidates(
        self, station: WorkStation, bundle: Bundle, units: Collection[int]
    ) -> list[Bin]:
        """Returns the bins on some units that have room for a bundle, not too far from a
        station."""
        bins = self._inventory.places(bundle.sku, bundle.quantity, units)
        near = set(self._within_reach(station, [bin_.unit for bin_ in bins]))
        return [bin_ for bin_ in bins if bin_.unit in near]

    def _within_reach(self, station: WorkStation, units: list[int]) -> list[int]:
        """Returns those of some units that are not too far from a station."""
        floor = self._view.floor
        if not units or np.isinf(floor.reach):
            return units
        seconds = floor.seconds_to_all(station.name, np.array(units))
        is_near = seconds <= seconds.min() + floor.reach
        return [unit for unit, near in zip(units, is_near.tolist()) if near]

    def _take_along(self) -> None:
        """Adds bundles that have come to visits under way, if the policy fills these."""
        came, self._came = self._came, []
        if not self._fills:
            return
        visits = [v for s in self.stations if s.is_open for v in s.coming_for(replenishes=True)]
        for bundle in came:
            if bundle.bundle_id in self._goods_in.bundles:
                any(self._add(visit, bundle) for visit in visits)

    def _fill_up(self, visit: Visit) -> None:
        """Adds other waiting bundles that have a place on the same unit to its visit."""
        waiting = self._by_urgency() if self._fills else [*self._goods_in.bundles.values()]
        for bundle in waiting:
            self._add(visit, bundle)

    def _add(self, visit: Visit, bundle: Bundle) -> bool:
        """Adds a waiting bundle to a visit if its unit has a place for it, and returns whether it
        has: in a bin of its SKU, or in an empty one if the policy fills visits, or little is
        left."""
        inventory, sku = self._inventory, bundle.sku
        # Most bins are of another SKU, and take nothing: they need no closer look.
        bins = [b for b in inventory.of_unit[visit.unit] if b.sku == sku or b.empty]
        places = [bin_ for bin_ in bins if inventory.takes(bin_, sku, bundle.quantity)]
        same = [bin_ for bin_ in places if bin_.sku == sku]
        if same:
            self._place(bundle, min(same, key=lambda bin_: bin_.room), visit)
        elif places and (self._fills or self._view.stock_of(sku) < bundle.quantity):
            self._place(bundle, places[0], visit)
        return bundle.bin is not None

    def _place(self, bundle: Bundle, bin_: Bin, visit: Visit) -> None:
        self._goods_in.remove(bundle)
        bundle.bin, bundle.sequence = bin_, self._task_numbers.number()
        self._inventory.expect(bin_, bundle.sku, bundle.quantity)
        visit.puts.append(bundle)

    # At the station.

    def on_arrival(self, visit: Visit) -> None:
        """Starts putting bundles into a unit that has arrived, or lets it leave."""
        self.next_bundle(visit.station)
        self.leave_if_done(visit.station)

    def next_bundle(self, station: WorkStation) -> None:
        """Starts putting in the next bundle, if the station is free and a unit is there."""
        visit = station.here
        if station.at_work or not visit or not visit.puts or station.mode == StationMode.MANUAL:
            return
        station.at_work = 1
        now = self._clock.now
        self._clock.schedule(now + station.seconds_a_bundle, self._put_in, (station, visit, now))

    def _put_in(self, argument: tuple[WorkStation, Visit, float]) -> None:
        station, visit, began = argument
        station.at_work = 0
        station.busy_s += self._clock.now - began
        if visit.here and visit.puts:
            self.put(visit, visit.puts[0])
        station.next_work()
        self.leave_if_done(station)

    def put(self, visit: Visit, bundle: Bundle) -> None:
        """Puts a bundle into its bin."""
        visit.puts.remove(bundle)
        self._inventory.put(
            bundle.bin, bundle.sku, bundle.quantity, station=visit.station, visit=visit
        )
        visit.pieces += bundle.quantity
        station = visit.station
        station.pieces += bundle.quantity
        self._context.tally.stored(self._clock.now, bundle)

    def drop_visit(self, visit: Visit) -> None:
        """Queues the bundles of a visit again if its unit does not come, or leaves early."""
        for bundle in visit.puts:
            self._return(bundle)
        visit.puts = deque()

    def drop_bin(self, bin_: Bin) -> None:
        """Queues the bundles for a bin again."""
        for visit in [v for s in self.stations for v in s.inbound.values() if v.unit == bin_.unit]:
            dropped = [bundle for bundle in visit.puts if bundle.bin is bin_]
            for bundle in dropped:
                visit.puts.remove(bundle)
                self._return(bundle)
            if dropped:
                self.leave_if_done(visit.station)

    def _return(self, bundle: Bundle) -> None:
        self._inventory.unexpect(bundle.bin, bundle.sku, bundle.quantity)
        bundle.bin = None
        self._goods_in.add(bundle)
        self._came.append(bundle)
        self._look = True

    def open(self, station: WorkStation) -> None:
        """Starts the work of a station that was opened, or whose mode was set."""
        self._look = True
        self.next_bundle(station)

    def close(self, station: WorkStation) -> None:
        """Queues the bundles of a station again and sends its units away."""
        for visit in station.coming_for(replenishes=True):
            self.drop_visit(visit)
            if not visit.here:
                self._visits.cancel(visit)
        self.leave_if_done(station)

    def leave_if_done(self, station: WorkStation) -> None:
        """Releases a unit with nothing left to put in."""
        visit = station.here
        if visit and visit.replenishes and not visit.puts:
            self._visits.release(visit)
            self._look = True
            self.next_bundle(station)
