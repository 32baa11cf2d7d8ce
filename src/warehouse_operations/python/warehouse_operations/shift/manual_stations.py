# SPDX-License-Identifier: Apache-2.0
"""The reports of people at stations in mode MANUAL."""

from collections import deque
from collections.abc import Mapping
from typing import cast

from warehouse_layout.message_enums import OrderEventKind, PickOutcome, StationMode
from warehouse_operations.shift.context import Context
from warehouse_operations.shift.order_book import OrderBook
from warehouse_operations.shift.picking import Picking
from warehouse_operations.shift.replenishing import Replenishing
from warehouse_operations.shift.taking_back import TakingBack
from warehouse_operations.shift.task_reports import Answer, Report, TaskNumbers
from warehouse_operations.shift.visits import Visits
from warehouse_operations.stock.inventory import Bin, Reason
from warehouse_operations.stock.orders import Bundle, Line
from warehouse_operations.stock.stations import Pick, Visit, WorkStation


class ManualPicking:
    """Carries out the reports of people at picking stations."""

    def __init__(
        self,
        context: Context,
        picking: Picking,
        order_book: OrderBook,
        visits: Visits,
        taking_back: TakingBack,
    ) -> None:
        self._clock, self._inventory = context.clock, context.inventory
        self._picking, self._order_book = picking, order_book
        self._visits, self._taking_back = visits, taking_back

    def confirm(self, station: WorkStation, sku: str, quantity: int) -> tuple[bool, str]:
        """Records pieces of a SKU as picked. Returns success and the fault."""
        visit, picks = self._asked(station, sku)
        asked = sum(pick.quantity for pick in picks)
        if not (visit and 0 < quantity <= asked):
            return False, f"{asked} of {sku} are asked for at {station.name} now"
        for pick in picks:
            pieces = min(quantity, pick.quantity)
            if pieces:
                self._picking.take(visit, pick, pieces)
                quantity -= pieces
        self._picking.complete(station)
        self._picking.leave_if_done(station)
        return True, ""

    def short(
        self, station: WorkStation, sku: str, lacking: int, reason: Reason = Reason.SHORT
    ) -> tuple[bool, str]:
        """Writes off pieces that are missing or damaged. Returns success and the fault."""
        visit, picks = self._asked(station, sku)
        if not visit or not picks:
            return False, f"none of {sku} is asked for at {station.name} now"
        bin_ = picks[0].bin
        if not 0 < lacking <= bin_.quantity:
            return False, f"{bin_.quantity} of {sku} are in stock in {bin_.item}"
        self._write_off(visit, bin_, lacking, reason)
        return True, ""

    def _write_off(self, visit: Visit, bin_: Bin, lacking: int, reason: Reason) -> list[Line]:
        """Writes off pieces of a bin; returns the lines that were to be served from it."""
        station, sku = visit.station, bin_.sku
        lines = [line for _, line in self._picking.drop_bin(bin_)]
        self._inventory.move(bin_, sku, -lacking, reason, station=station)
        for line in lines:
            fields = sku, lacking, station.name, visit.unit, reason.value
            self._order_book.publish_event(line.order, OrderEventKind.SHORT, *fields)
            self._picking.allot(station, line)
        self._picking.leave_if_done(station)
        return lines

    def task(self, station: WorkStation, report: Report) -> Pick | None:
        """Returns the Pick that a Report names, from the unit at the station, or None."""
        visit = station.here
        named = report.order_id, report.item, report.sequence
        picks = visit.picks if visit else ()
        is_it = lambda p: (p.line.order.order_id, p.bin.item, p.sequence) == named  # noqa: E731
        return next(filter(is_it, picks), None)

    def asks(self, station: WorkStation) -> str:
        """Returns a sentence about the current task of a person."""
        visit = station.here
        if not visit or not visit.picks:
            return f"{station.name} asks for nothing now"
        pick = visit.picks[0]
        what = f"{pick.quantity} of {pick.line.sku} in {pick.bin.item}"
        return f"{station.name} asks for {what} for {pick.line.order.reference} now"

    def report(self, station: WorkStation, pick: Pick, report: Report) -> Answer:
        """Carries out a Report of a Pick."""
        # The pick is of the unit at the station: task() searches there.
        visit, bin_, sku = cast(Visit, station.here), pick.bin, pick.line.sku
        if report.outcome == PickOutcome.DONE:
            if not 0 < report.quantity <= pick.quantity:
                return Answer(False, f"{pick.quantity} of {sku} were expected at most")
            taken = visit, pick, report.quantity
            self._picking.take(*taken)
            self._picking.complete(station)
            self._picking.leave_if_done(station)
            when = self._clock.now
            return Answer(True, "", report.quantity, lambda: self._taking_back.pick(*taken, when))
        is_empty = report.outcome == PickOutcome.SHORT and not report.quantity
        lacking = bin_.quantity if is_empty else report.quantity
        if not 0 < lacking <= bin_.quantity:
            return Answer(False, f"{bin_.quantity} of {sku} are in stock in {bin_.item}")
        reason = Reason.SHORT if report.outcome == PickOutcome.SHORT else Reason.DAMAGED
        lines = self._write_off(visit, bin_, lacking, reason)
        undo = lambda: self._put_back(station, bin_, (sku, lacking), lines)  # noqa: E731
        return Answer(True, f"{lacking} of {sku} in {bin_.item} are written off", lacking, undo)

    def _put_back(
        self, station: WorkStation, bin_: Bin, pieces: tuple[str, int], lines: list[Line]
    ) -> str:
        """Puts (SKU, pieces) that were written off back into their bin.

        They serve the same lines again if the unit is still there. Returns the reason of a refusal,
        or "".
        """
        sku, quantity = pieces
        if bin_.room < quantity or not (bin_.empty or bin_.sku == sku):
            return f"{bin_.item} has no room for {quantity} of {sku} any more"
        self._inventory.move(bin_, sku, quantity, Reason.UNDONE, station=station)
        visit = station.here
        if visit and visit.unit == bin_.unit:
            for line in lines:
                if line.order.order_id in station.orders:
                    self._take_from_others(station, line)
                    self._picking.allot(station, line)
            visit.picks = deque(sorted(visit.picks, key=lambda pick: pick.bin is not bin_))
        elif bin_.unit in self._visits.free_units:
            self._picking.on_unit_free(bin_.unit)
        return ""

    def _take_from_others(self, station: WorkStation, line: Line) -> None:
        """Drops a line's picks from units on their way; cancels visits without other picks."""
        for visit in [visit for visit in station.coming if not visit.here]:
            for pick in [pick for pick in visit.picks if pick.line is line]:
                self._picking.drop(visit, pick)
                if not visit.picks:
                    self._visits.cancel(visit)

    def _asked(self, station: WorkStation, sku: str) -> tuple[Visit | None, list[Pick]]:
        visit = station.here
        return visit, [pick for pick in visit.picks if pick.line.sku == sku] if visit else []


class ManualReplenishing:
    """Carries out the reports of people at replenishing stations."""

    def __init__(
        self,
        context: Context,
        replenishing: Replenishing,
        task_numbers: TaskNumbers,
        taking_back: TakingBack,
    ) -> None:
        self._clock, self._inventory = context.clock, context.inventory
        self._replenishing, self._task_numbers = replenishing, task_numbers
        self._taking_back = taking_back

    def confirm(self, station: WorkStation, sku: str, quantity: int) -> tuple[bool, str]:
        """Records the bundle of a SKU as put in. Returns success and the fault."""
        visit, bundle = self._asked(station, sku)
        if not visit or not bundle or bundle.quantity != quantity:
            asked = f"{bundle.quantity} of {sku}" if bundle else f"none of {sku}"
            return False, f"{asked} are to be put in at {station.name} now"
        self._replenishing.put(visit, bundle)
        self._replenishing.leave_if_done(station)
        return True, ""

    def short(
        self, station: WorkStation, sku: str, lacking: int, _reason: Reason
    ) -> tuple[bool, str]:
        """Removes missing or damaged pieces from a bundle: they were never in the stock.

        Returns success and the fault.
        """
        visit, bundle = self._asked(station, sku)
        there = bundle.quantity if bundle else 0
        if not (visit and bundle and 0 < lacking <= there):
            return False, f"{there} of {sku} are to be put in at {station.name} now"
        self._shorten(visit, bundle, lacking)
        return True, ""

    def _shorten(self, visit: Visit, bundle: Bundle, lacking: int) -> None:
        """Takes pieces out of a bundle before it is put in."""
        self._inventory.unexpect(bundle.bin, bundle.sku, lacking)
        bundle.quantity -= lacking
        bundle.sequence = self._task_numbers.number()  # what is left is another task
        if not bundle.quantity:
            visit.puts.remove(bundle)
        self._replenishing.leave_if_done(visit.station)

    def task(self, station: WorkStation, report: Report) -> Bundle | None:
        """Returns the Bundle that a Report names, for the unit at the station, or None."""
        visit, named = station.here, (0, report.item, report.sequence)
        puts = visit.puts if visit and not report.order_id else ()
        return next((b for b in puts if (0, b.bin.item, b.sequence) == named), None)

    def asks(self, station: WorkStation) -> str:
        """Returns a sentence about the current task of a person."""
        visit = station.here
        if not visit or not visit.puts:
            return f"{station.name} asks for nothing now"
        bundle = visit.puts[0]
        return (
            f"{station.name} asks for {bundle.quantity} of {bundle.sku} into {bundle.bin.item} now"
        )

    def report(self, station: WorkStation, bundle: Bundle, report: Report) -> Answer:
        """Carries out a Report of a Bundle."""
        # The bundle is for the unit at the station: task() searches there.
        visit, there = cast(Visit, station.here), bundle.quantity
        if report.outcome == PickOutcome.DONE:
            if report.quantity != there:
                return Answer(False, f"a bundle of {there} of {bundle.sku} goes in whole")
            self._replenishing.put(visit, bundle)
            self._replenishing.leave_if_done(station)
            when = self._clock.now
            return Answer(True, "", there, lambda: self._taking_back.put(visit, bundle, when))
        lacking = report.quantity
        if not 0 < lacking <= there:
            return Answer(False, f"{there} of {bundle.sku} are to be put in")
        self._shorten(visit, bundle, lacking)
        undo = lambda: self._lengthen(visit, bundle, lacking)  # noqa: E731
        return Answer(True, f"{lacking} of {bundle.sku} are not put in", lacking, undo)

    def _lengthen(self, visit: Visit, bundle: Bundle, pieces: int) -> str:
        """Adds removed pieces to their bundle again, or orders them as another one."""
        is_there = visit.here and (bundle in visit.puts or not bundle.quantity)
        if is_there and self._inventory.takes(bundle.bin, bundle.sku, pieces):
            self._inventory.expect(bundle.bin, bundle.sku, pieces)
            if not bundle.quantity:
                visit.puts.appendleft(bundle)
            bundle.quantity += pieces
            bundle.sequence = self._task_numbers.number()
        else:
            self._replenishing.order(bundle.sku, pieces)
        return ""

    def _asked(self, station: WorkStation, sku: str) -> tuple[Visit | None, Bundle | None]:
        visit = station.here
        return visit, next((b for b in visit.puts if b.sku == sku), None) if visit else None


class ManualStations:
    """The stations at which people work, by name, and the parts that carry out their reports."""

    def __init__(
        self,
        context: Context,
        stations: Mapping[str, WorkStation],
        picking: ManualPicking,
        replenishing: ManualReplenishing,
    ) -> None:
        self._clock, self._stations = context.clock, stations
        self._picking, self._replenishing = picking, replenishing

    def part_of(self, station: WorkStation) -> ManualPicking | ManualReplenishing:
        """Returns the part of the shift that takes reports of people at a station now."""
        here = station.here
        replenishes = here.replenishes if here else not station.picks
        return self._replenishing if replenishes else self._picking

    def confirm(self, name: str, sku: str, quantity: int) -> tuple[bool, str]:
        """Records pieces as picked, or put in, by a person. Returns success and the fault."""
        station = self._stations.get(name)
        if not station:
            return False, f"there is no station '{name}'"
        if station.mode != StationMode.MANUAL:
            return False, f"{name} works by itself"
        station.attended = self._clock.now
        return self.part_of(station).confirm(station, sku, quantity)

    def short(self, name: str, sku: str, lacking: int, damaged: bool = False) -> tuple[bool, str]:
        """Writes off pieces that are missing or damaged. Returns success and the fault."""
        station = self._stations.get(name)
        if not station:
            return False, f"there is no station '{name}'"
        reason = Reason.DAMAGED if damaged else Reason.SHORT
        station.attended = self._clock.now
        return self.part_of(station).short(station, sku, lacking, reason)
