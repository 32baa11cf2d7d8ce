# SPDX-License-Identifier: Apache-2.0
"""Picking: orders to stations, units for their lines, and piece by piece into the totes."""

import math
from collections import defaultdict

from warehouse_operations.message_enums import Mode, OrderEventKind, OrderState
from warehouse_operations.stations import Pick

RETRY = 1.0  # after the fleet refused a unit [s]
LOOK = 1.0  # between two looks of stations with a free slot at orders that have come [s]
LATER = 0.1  # after which stations choose on that did not come to it [s]
EFFORT = 200_000  # lines of orders that are looked at in a step, at most: about 0.1 s of work


class Picking:
    """The part of a Shift that works at its picking stations."""

    def __init__(self, shift, stations):
        self.shift, self.stations = shift, stations
        self._to_assign, self._to_fetch = dict.fromkeys(stations), {}
        self._is_to_look, self._next_look = False, -math.inf
        self._effort, self._put_off = (
            EFFORT,
            {},
        )  # what is left of a step; stations that wait for it
        self._missing = defaultdict(dict)  # lines without a unit, with their station, by SKU

    # What makes work.

    def on_backlog_change(self):
        """Orders that come one after the other are looked at together: each look costs as much as
        there are orders and stations."""
        if self.shift.now >= self._next_look:
            self._check_backlog(None)
        elif not self._is_to_look:
            self._is_to_look = True
            self.shift.events.schedule(self._next_look, self._check_backlog)

    def _check_backlog(self, _):
        self._is_to_look, self._next_look = False, self.shift.now + LOOK
        for station in self.stations:
            if station.free_slots and station.is_open:
                self._to_assign[station] = None

    def on_unit_free(self, unit):
        """A unit stands in storage: it may hold what stations lack."""
        for one in self.shift.inventory.of_unit[unit]:
            if one.available and one.sku in self._missing:
                for station in self._missing[one.sku].values():
                    self._to_fetch[station] = None

    def missing(self):
        """Pieces for which no unit comes, by SKU."""
        return {
            sku: sum(station.missing[key].missing for key, station in lines.items())
            for sku, lines in self._missing.items()
            if lines
        }

    def work(self):
        """Gives out orders and asks for units where something has changed."""
        while self._to_assign or self._to_fetch:
            for station in sorted(self._to_assign, key=lambda one: -one.free_slots):
                self._assign(station)
            self._to_assign.clear()
            stations, self._to_fetch = self._to_fetch, {}
            for station in stations:
                self._fetch(station)
        self._effort = EFFORT

    # Orders.

    def _assign(self, station):
        while station.is_open and station.free_slots > 0 and len(self.shift.backlog):
            if self._effort <= 0:
                self._assign_later(station)
                return
            self._effort -= self.shift.backlog.lines
            order = self.shift.policies.orders.choose(station, self.shift.view)
            if order is None:
                return
            self.shift.backlog.remove(order)
            self._take_on(station, order)

    def _assign_later(self, station):
        if not self._put_off:
            self.shift.events.schedule(self.shift.now + LATER, self._assign_put_off)
        self._put_off[station] = None

    def _assign_put_off(self, _):
        self._to_assign.update(self._put_off)
        self._put_off = {}

    def _take_on(self, station, order):
        order.state, order.station, order.assigned = (
            OrderState.ASSIGNED,
            station.name,
            self.shift.now,
        )
        station.orders[order.order_id] = order
        self.shift.journal.assigned(order)
        self.shift.order_book.publish_event(order, OrderEventKind.ASSIGNED)
        for line in order.lines:
            self.allot(station, line)

    def allot(self, station, line):
        """What units at the station or on their way can serve is reserved for the line."""
        for visit in station.coming:
            for one in self.shift.inventory.of_unit[visit.unit]:
                pieces = min(line.missing, one.available) if one.sku == line.sku else 0
                if pieces > 0:
                    self._reserve(visit, line, one, pieces)
        self._note(station, line)
        here = station.here
        if here and here.picks:
            self.next_piece(station)

    def _reserve(self, visit, line, one, pieces):
        self.shift.inventory.reserve(one, pieces)
        line.allotted += pieces
        visit.picks.append(Pick(line, one, pieces, self.shift.tasks.number()))

    def _note(self, station, line):
        """Keeps the lines for which units are to be fetched up to date."""
        key = line.order.order_id, line.number
        if line.missing > 0 and line.order.order_id in station.orders:
            station.missing[key] = line
            self._missing[line.sku][key] = station
            self._to_fetch[station] = None
        elif key in station.missing:
            del station.missing[key]
            del self._missing[line.sku][key]

    def _return(self, station, order):
        """An order leaves its station unfinished."""
        del station.orders[order.order_id]
        for visit in station.inbound.values():
            for pick in [pick for pick in visit.picks if pick.line.order is order]:
                self.drop(visit, pick)
        for line in order.lines:
            self._note(station, line)
        order.station = ""
        self._to_assign[station] = None
        self.shift.journal.unassigned(order, self.shift.now)

    def drop(self, visit, pick):
        visit.picks.remove(pick)
        pick.line.allotted -= pick.quantity
        self.shift.inventory.reserve(pick.bin, -pick.quantity)

    def cancel(self, order):
        """Takes an order away from the station that has it."""
        station = self.shift.station(order.station)
        self._return(station, order)
        self.leave_if_done(station)

    def drop_visit(self, visit):
        """The unit does not come, or leaves early: what it was to serve is missing again."""
        lines = [pick.line for pick in visit.picks]
        for pick in list(visit.picks):
            self.drop(visit, pick)
        for line in lines:
            self._note(visit.station, line)
        self._to_fetch[visit.station] = None  # there is room for another one

    def drop_bin(self, one):
        """Nothing is to be taken out of a bin; returns (visit, line) of what it was to serve."""
        dropped = [(v, p) for v in self._visits_of(one.unit) for p in v.picks if p.bin is one]
        for visit, pick in dropped:
            self.drop(visit, pick)
        return [(visit, pick.line) for visit, pick in dropped]

    def serve_otherwise(self, dropped):
        """What drop_bin returned comes out of other bins."""
        for visit, line in dropped:
            self.allot(visit.station, line)
            self.leave_if_done(visit.station)

    def open(self, station):
        self.on_backlog_change()
        self.next_piece(station)

    def close(self, station):
        """Its orders go to others, its units are sent away."""
        for visit in list(station.coming):
            self.drop_visit(visit)
            if not visit.here:
                self.shift.visits.cancel(visit)
        self.leave_if_done(station)
        for order in list(station.orders.values()):
            if not order.done:
                self._return(station, order)
                self.shift.order_book.reopen(order)

    # Units.

    def _fetch(self, station):
        limit = self.shift.units_per_station
        while station.is_open and station.missing and len(station.coming) < limit:
            candidates = self._candidates(station)
            if not candidates:
                return
            unit = self.shift.policies.units.choose(station, candidates, self.shift.view)
            visit = self.shift.visits.request(unit, station)
            if not visit:
                self.shift.events.schedule(self.shift.now + RETRY, self._retry, station)
                return
            for line in candidates[unit]:
                self.allot(station, line)

    def _retry(self, station):
        self._to_fetch[station] = None

    def _candidates(self, station):
        """What the units that are free could serve: {unit: {line: pieces}}."""
        result = {}
        for line in station.missing.values():
            for one in self.shift.inventory.with_sku(line.sku):
                if one.quantity > one.reserved and one.unit in self.shift.free_units:
                    lines = result.setdefault(one.unit, {})
                    there = lines.get(line, 0)
                    lines[line] = min(line.missing, there + one.available)
        return result

    # At the station.

    def on_arrival(self, visit):
        self._to_assign[visit.station] = None
        self.next_piece(visit.station)
        self.leave_if_done(visit.station)

    def next_piece(self, station):
        """Begins with the next piece, if the picker is free and a unit is there."""
        visit = station.here
        if station.at_work or not visit or not visit.picks or station.mode == Mode.MANUAL:
            return
        station.at_work = True
        now = self.shift.now
        self.shift.events.schedule(now + station.pick_seconds, self._taken, (station, visit))
        self.shift.events.schedule(now + station.seconds_a_piece, self._in_tote, (station, now))

    def _taken(self, argument):
        """A piece is out of its bin: the unit may leave if it was the last."""
        station, visit = argument
        if visit.here and visit.picks:  # else the order was cancelled meanwhile
            self.take(visit, visit.picks[0], 1)
            self.leave_if_done(station)

    def _in_tote(self, argument):
        station, began = argument
        station.at_work = False
        station.busy_s += self.shift.now - began
        self.complete(station)
        self.next_piece(station)

    def take(self, visit, pick, pieces):
        """So many pieces of a pick leave the stock."""
        line, station = pick.line, visit.station
        self.shift.inventory.pick(pick.bin, pieces, line=line, station=station, visit=visit)
        pick.quantity -= pieces
        line.allotted -= pieces
        line.picked += pieces
        if pick.quantity:
            pick.sequence = self.shift.tasks.number()  # what is left is another task
        else:
            visit.picks.remove(pick)
        visit.pieces += pieces
        station.pieces += pieces
        self.shift.tally.picked(self.shift.now, pieces, line)
        self.shift.journal.line(line)
        self.shift.order_book.publish_event(
            line.order, OrderEventKind.PICKED, line.sku, pieces, station.name, visit.unit
        )

    def complete(self, station):
        for order in [order for order in station.orders.values() if order.done]:
            del station.orders[order.order_id]
            order.state, order.completed = OrderState.COMPLETED, self.shift.now
            self.shift.order_book.end(order, OrderEventKind.COMPLETED, station=station.name)
            self._to_assign[station] = None

    def leave_if_done(self, station):
        """A unit with nothing left to pick goes, unless an order that it serves can be taken on."""
        visit = station.here
        if not visit or visit.picks:
            return
        self._assign(station)
        if not visit.picks:
            self.shift.visits.release(visit)
            self._to_assign[station] = self._to_fetch[station] = None

    def _visits_of(self, unit):
        return [v for s in self.stations for v in s.inbound.values() if v.unit == unit]
