# SPDX-License-Identifier: Apache-2.0
"""Orders and stock as a ROS node: a shift over the coordinator of a running warehouse."""

import contextlib
import threading
from time import monotonic as clock
from time import sleep, time_ns
from types import SimpleNamespace

import numpy as np
import rospy
from nav_msgs.srv import GetMap
from std_msgs.msg import Header

from warehouse_client.unit_messages import unit_ids, unit_poses
from warehouse_fleet.failures import FailureLog
from warehouse_fleet.people import PeopleLog
from warehouse_fleet.transports import ENDS, Answer, Kind, TransportEvent
from warehouse_layout.floor_plan import FloorPlan
from warehouse_layout.served_part import served_part
from warehouse_msgs import msg, srv
from warehouse_operations import kpis, queries, stored
from warehouse_operations.changes import ChangeJournal
from warehouse_operations.database import Database
from warehouse_operations.demand import DemandError
from warehouse_operations.floor_heat import SLICES, FloorHeat
from warehouse_operations.opening import open_shift
from warehouse_operations.site import Site
from warehouse_operations.tasks import Outcome, Report

BUILDING = "/warehouse/building"  # is set while half a warehouse stands
FAREWELL = 1.0  # for so long the last notice is offered to those who listen [s, wall]
CYCLE = 0.1  # between two looks at what has happened [s]
STATIONS_PERIOD, KPIS_PERIOD = 1.0, 10.0  # [s], simulated
SHOWN = 60  # intervals of the throughput: an hour
WAITS = (msg.KivaStatus.STATE_WAITING, msg.KivaStatus.STATE_BLOCKED)  # robots under way
UNKEPT = 100  # most transports that a run asks for between two writes to the database


class Coordinator:
    """The coordinator of another node, with the face of protocols.Requests."""

    def __init__(self):
        self._heard = []
        self._open = set()  # transports that this run asked for
        self._left = set()  # transports that an earlier run asked for
        self._last_left = None  # the newest of them that is known, until this run asks for one
        self._lock = threading.Lock()
        self.state = None
        self._submit = rospy.ServiceProxy("/warehouse/transport", srv.Transport)
        self._release = rospy.ServiceProxy("/warehouse/release_transport", srv.ReleaseTransport)
        self._cancel = rospy.ServiceProxy("/warehouse/cancel_transport", srv.CancelTransport)
        rospy.Subscriber("/warehouse/transports", msg.TransportEvent, self._hear, queue_size=10000)
        rospy.Subscriber("/warehouse/coordinator", msg.CoordinatorState, self._see, queue_size=1)

    def submit(self, shelf_id, station="", x=0.0, y=0.0, then=0, priority=0):
        try:
            answer = self._submit(shelf_id, station, x or 0.0, y or 0.0, then, priority)
        except rospy.ServiceException as error:
            return Answer(0, False, str(error))
        if answer.accepted:
            self._release_unknown(answer.transport_id)
            self._open.add(answer.transport_id)
        return Answer(answer.transport_id, answer.accepted, answer.message)

    def release(self, transport_id):
        return self._call(self._release, transport_id)

    def cancel(self, transport_id):
        return self._call(self._cancel, transport_id)

    @staticmethod
    def _call(service, transport_id):
        try:
            answer = service(transport_id)
        except rospy.ServiceException as error:
            return False, str(error)
        return answer.success, answer.message

    def begin(self):
        """A run that has asked for nothing yet."""
        with self._lock:
            self._heard = []
        self._open, self._left, self._last_left = set(), set(), None

    def set_open(self, station, is_open):
        """The coordinator is not told: a shift asks for nothing at a closed station, and cancels
        what it has asked for."""

    def release_left(self, transports, last):
        """Lets go what an earlier run asked for, the newest known `last`: at once, or when it
        arrives."""
        self._left.update(number for number in transports if not self.release(number)[0])
        self._last_left = last

    def _release_unknown(self, first):
        """What the earlier run was killed over before it was kept: all up to this run's `first`."""
        if self._last_left is not None:
            self.release_left(range(max(self._last_left + 1, first - UNKEPT), first), None)

    def take_events(self):
        with self._lock:
            heard, self._heard = self._heard, []
        known = []
        for event in heard:
            if event.transport_id in self._open:
                known.append(event)
                if event.kind in ENDS:
                    self._open.discard(event.transport_id)
            elif event.transport_id in self._left and event.kind == Kind.ARRIVED:
                self._left.discard(event.transport_id)
                self.release(event.transport_id)
        return known

    def _hear(self, event):
        with self._lock:
            self._heard.append(
                TransportEvent(
                    event.header.stamp.to_sec(),
                    event.transport_id,
                    Kind(event.kind),
                    event.kiva_id,
                    event.shelf_id,
                    event.station,
                    event.text,
                )
            )

    def _see(self, state):
        self.state = state


class Warehouse:
    """What the other nodes tell about the warehouse; `distance_m` that all robots have driven, and
    the FloorHeat that they leave, once somebody has set it."""

    def __init__(self):
        self.fleet = self.objects = self.units = self.scenery = None
        self.distance_m, self.heat = 0.0, None
        self.failures, self.people, self._there = FailureLog(), PeopleLog(), msg.People()
        for topic, kind, name in (
            ("objects", msg.WarehouseObjects, "objects"),
            ("unit_states", msg.UnitStates, "units"),
            ("scenery", msg.Scenery, "scenery"),
            ("people", msg.People, "_there"),
        ):
            rospy.Subscriber(f"/warehouse/{topic}", kind, self._keep, name, queue_size=1)
        rospy.Subscriber("/warehouse/fleet", msg.FleetState, self._on_fleet, queue_size=10)

    def begin(self, heat):
        """Counts from now on, heat where it is told."""
        self.distance_m, self.heat = 0.0, heat
        self.failures, self.people = FailureLog(), PeopleLog()

    def _keep(self, message, name):
        setattr(self, name, message)

    def _on_fleet(self, message):
        before, self.fleet = self.fleet, message
        if before and before.kiva_id == message.kiva_id:
            dx, dy = np.subtract(message.x, before.x), np.subtract(message.y, before.y)
            moved = np.hypot(dx, dy)
            self.distance_m += float(moved[moved < 1.0].sum())  # farther: it was put there
        now = message.stamp.to_sec()
        self.failures.observe(now, np.frombuffer(message.failures, np.uint8))
        self.people.observe(now, self._there, len(message.kiva_id))
        if self.heat:
            waits = np.isin(np.frombuffer(bytes(message.state), np.uint8), WAITS)
            self.heat.update(now, message.x, message.y, waits)

    @property
    def is_known(self):
        told = self.fleet, self.objects, self.units, self.scenery
        if None in told or self.objects.revision != self.units.revision:
            return False
        return self.fleet.timeline == self.units.timeline

    def is_known_at(self, now):
        """Not from a time that is still to come, before that was gone back [s]."""
        return self.is_known and self.fleet.stamp.to_sec() <= now

    def site(self):
        """The Site of it."""
        floor_map = rospy.ServiceProxy("/warehouse/map", GetMap)().map
        plan, _ = served_part(FloorPlan.of_messages(floor_map, self.scenery))
        robots = self.fleet
        units = unit_ids(self.objects)
        return Site(
            plan,
            dict(zip(robots.kiva_id, plan.cell_of(robots.x, robots.y).tolist())),
            dict(zip(units, self._unit_cells(plan))),
            [(item, units[unit]) for item, unit in self._homes() if unit >= 0],
            rospy.get_param("/warehouse/name", ""),
        )

    def _homes(self):
        """(item, index of the unit on which it belongs; -1 = on none)."""
        objects, unit_of = self.objects, list(self.objects.item_unit)
        for item, unit in zip(objects.fallen_item, objects.fallen_from):
            unit_of[item] = unit
        return zip(objects.items, unit_of)

    @property
    def fallen_items(self):
        """Those that lie on the floor, by name."""
        return [self.objects.items[item] for item in self.objects.fallen_item]

    def standing(self, plan):
        """The cells of the units that nobody carries, by id."""
        if not self.is_known:
            return {}
        told = zip(unit_ids(self.objects), self._unit_cells(plan), self.units.carrier)
        return {unit: cell for unit, cell, carrier in told if not carrier and cell >= 0}

    def _unit_cells(self, plan):
        x, y, _ = unit_poses(self.units)
        return plan.cell_of(x, y).tolist()


class OperationsNode:
    """Runs a shift and serves it. Raises what open_shift does."""

    def __init__(self, database, orders="fill", policies=None, seed=1):
        self._lock = threading.RLock()  # of the shift, between the loop and services
        self._warehouse, self._coordinator = Warehouse(), Coordinator()
        self._warned = set()
        self._notices = _publisher("/warehouse/notices", msg.Notices)
        self._kpis = _publisher("/warehouse/kpis", msg.Kpis)
        self._throughput = _publisher("/warehouse/throughput", msg.Throughput)
        self._heat = _publisher("/warehouse/heat", msg.HeatMap)
        self._orders = _queued("/warehouse/order_changes", msg.OrderStatuses)
        self._stock = _queued("/warehouse/stock_changes", msg.StockPlaces)
        self._events = rospy.Publisher("/warehouse/order_events", msg.OrderEvent, queue_size=10000)
        self._chosen = {"orders": orders, "policies": policies, "seed": seed}
        self._wait_for_warehouse()
        self._database = Database(database)
        self._begin()
        for name, kind, call in (
            ("submit_order", srv.SubmitOrder, self._submit),
            ("cancel_order", srv.CancelOrder, self._cancel),
            ("set_station", srv.SetStation, self._set_station),
            ("confirm_pick", srv.ConfirmPick, self._confirm),
            ("report_short", srv.ReportShort, self._short),
            ("report_pick", srv.ReportPick, self._report),
            ("undo_write_off", srv.UndoWriteOff, self._undo_write_off),
            ("find_orders", srv.FindOrders, self._find_orders),
            ("find_stock", srv.FindStock, self._find_stock),
        ):
            rospy.Service(f"/warehouse/{name}", kind, call)
        # Last of all: whoever hears it finds the services there.
        self._stations = _publisher("/warehouse/stations", msg.StationStates)

    def _begin(self):
        """A shift that goes on with what the database has."""
        engine, now = self._database.engine, rospy.get_time()
        self._timeline = self._warehouse.fleet.timeline
        self._site = self._warehouse.site()
        self._coordinator.begin()
        heat = FloorHeat(self._site.plan, now)
        since = max(0.0, (now // kpis.INTERVAL + 1 - SHOWN) * kpis.INTERVAL)
        with self._database.reading():
            left = stored.transports_left(engine)
            heat.restore(stored.heat(engine, now))
            self._before = stored.throughput(engine, now, since)
        self._coordinator.release_left(*left)
        self._shift = self._open_shift(now)
        self._shift.on_order_event = self._tell
        # What a page was shown by an earlier run has other numbers [ms, wall].
        self._shift.tasks.number_from(time_ns() // 10**6)
        self._shift.notices.on_change = self._tell_notices
        self._tell_notices()
        self._changes = self._shift.journal = ChangeJournal(self._shift.journal)
        self._warehouse.begin(heat)
        self._keep_heat(SLICES)  # by the times of this run
        self._began = clock()
        self._next_stations = self._next_kpis = now
        rospy.loginfo(
            f"{len(self._site.units)} storage units, {len(self._site.items)} bins, "
            f"{len(self._shift.orders)} orders to go on with"
        )

    def _open_shift(self, now):
        """A Shift; without the orders of a file that this warehouse can't take."""

        def begin(orders):
            chosen = self._chosen | {"orders": orders}
            return open_shift(
                self._site, self._coordinator, database=self._database, now=now, **chosen
            )

        try:
            return begin(self._chosen["orders"])
        except DemandError as error:
            shift = begin("none")
            first, *more = str(error).splitlines()
            told = f"{first} (and {len(more)} more)" if more else first
            shift.notices.add(f"no orders come from the file: {told}")
            return shift

    def _tell_notices(self):
        for text in set(self._shift.notices) - self._warned:
            rospy.logwarn(text)
        self._warned = set(self._shift.notices)
        self._notices.publish(msg.Notices(_header(self._shift.now), list(self._shift.notices)))

    def run(self):
        """Until ROS shuts down."""
        while not rospy.is_shutdown():
            with self._lock:
                now = rospy.get_time()
                if now < self._shift.now or self._warehouse.fleet.timeline != self._timeline:
                    self._begin_anew(now)
                else:
                    self._step(now)
            _pause()

    def _keep_heat(self, slices):
        for kept in self._warehouse.heat.kept(slices):
            self._shift.journal.heat(*kept)

    def _begin_anew(self, now):
        """The world was reset, restored or undone: stock and orders are as they are, transports are
        not."""
        rospy.logwarn(f"the world jumped from {self._shift.now:g} s to {now:g} s")
        self._shift.journal.end(self._shift, self._figures())
        self._shift.journal.flush()
        self._wait_for_warehouse()
        self._begin()

    def close(self):
        """Writes what is left to the database."""
        with self._lock:
            self._shift.journal.end(self._shift, self._figures())
            self._database.close()

    def _wait_for_warehouse(self):
        while not (
            self._warehouse.is_known_at(rospy.get_time())
            and self._is_coordinated()
            and not rospy.has_param(BUILDING)
        ):
            if rospy.is_shutdown():
                raise rospy.ROSInterruptException("shut down before there was a warehouse")
            _pause()

    def _is_coordinated(self):
        state = self._coordinator.state
        if state is None or not len(state.station):
            return False
        return state.timeline == self._warehouse.fleet.timeline

    def _step(self, now):
        if now >= self._next_stations:
            self._shift.floor.cells = self._warehouse.standing(self._site.plan)
            if self._warehouse.is_known:
                self._shift.update_units(set(unit_ids(self._warehouse.objects)))
        self._shift.fallen.update(self._warehouse.fallen_items)
        self._shift.advance(now)
        self._tell_changes(now)
        if now >= self._next_stations:
            self._next_stations = now + STATIONS_PERIOD
            self._tell_stations()
        if now >= self._next_kpis:
            self._next_kpis = now + KPIS_PERIOD
            self._kpis.publish(self._kpis_message(now))
            self._throughput.publish(self._throughput_message(now))
            self._heat.publish(self._heat_message(now))
            self._keep_heat(slices=1)

    # Services.

    def _submit(self, request):
        due = request.due.to_sec()
        lines = [(line.sku, line.quantity) for line in request.lines]
        with self._lock:
            order, message = self._shift.submit(lines, due, request.priority, request.reference)
            self._shift.journal.commit(self._shift)
        self._shift.journal.flush()
        return srv.SubmitOrderResponse(order.order_id if order else 0, bool(order), message)

    def _cancel(self, request):
        return srv.CancelOrderResponse(*self._do(self._shift.cancel_order, request.order_id))

    def _set_station(self, request):
        if request.mode not in (srv.SetStationRequest.AUTOMATIC, srv.SetStationRequest.MANUAL):
            text = f"mode is {request.mode}; 0 (AUTOMATIC) or 1 (MANUAL) was expected"
            return srv.SetStationResponse(False, text)
        arguments = request.station, request.open, request.mode
        return srv.SetStationResponse(*self._do(self._shift.set_station, *arguments))

    def _confirm(self, request):
        arguments = request.station, request.sku, request.quantity
        return srv.ConfirmPickResponse(*self._do(self._shift.confirm_pick, *arguments))

    def _short(self, request):
        arguments = request.station, request.sku, request.quantity, request.damaged
        return srv.ReportShortResponse(*self._do(self._shift.report_short, *arguments))

    def _report(self, request):
        if request.outcome not in Outcome.__members__.values():
            text = f"outcome is {request.outcome}; 0 (DONE), 1 (SHORT) or 2 (DAMAGED) was expected"
            return srv.ReportPickResponse(False, text, 0)
        fields = request.station, request.order_id, request.item, request.sequence
        report = Report(*fields, request.quantity, Outcome(request.outcome))
        answer = self._do(self._shift.tasks.report, report)
        self._tell_stations()
        return srv.ReportPickResponse(answer.success, answer.message, answer.quantity)

    def _undo_write_off(self, request):
        done = self._do(self._shift.tasks.undo, request.station, request.sequence)
        self._tell_stations()
        return srv.UndoWriteOffResponse(*done)

    def _find_orders(self, request):
        total, found = queries.find_orders(
            self._database.engine,
            request.order_id,
            request.search,
            None if request.state < 0 else request.state,
            request.limit,
            request.offset,
            self._shift.now if request.late else None,
        )
        return srv.FindOrdersResponse(total, [_stored_order(*one) for one in found])

    def _find_stock(self, request):
        total, pieces, found = queries.find_stock(
            self._database.engine, request.sku, request.limit, request.offset
        )
        return srv.FindStockResponse(total, pieces, [_place(one) for one in found])

    def _do(self, act, *arguments):
        """Does it and keeps it; returns what it does."""
        with self._lock:
            answer = act(*arguments)
            self._shift.journal.commit(self._shift)
        self._shift.journal.flush()
        return answer

    # Topics.

    def _tell(self, order, kind, sku, quantity, station, unit, text):
        event = msg.OrderEvent(
            order_id=order.order_id,
            kind=kind,
            sku=sku,
            quantity=quantity,
            station=station,
            shelf_id=unit,
            text=text,
        )
        event.header.stamp = rospy.Time.from_sec(self._shift.now)
        self._events.publish(event)

    def _tell_changes(self, now):
        """Publishes orders and bins as they are now, if they have changed."""
        for publisher, kind, rows in (
            (self._orders, msg.OrderStatuses, map(_order, self._changes.take_orders())),
            (self._stock, msg.StockPlaces, map(_place, self._changes.take_bins())),
        ):
            if rows := list(rows):
                publisher.publish(kind(_header(now), rows))

    def _throughput_message(self, now):
        tally, last = self._shift.tally, int(now // kpis.INTERVAL)
        began, *before = self._before
        first = max(int(began // kpis.INTERVAL), last + 1 - SHOWN)
        counts = zip(before, (tally.picked_in, tally.stored_in, tally.completed_in))
        series = (
            [of.get(i, 0) + now_of.get(i, 0) for i in range(first, last + 1)]
            for of, now_of in counts
        )
        begin = max(first * kpis.INTERVAL, began)
        return msg.Throughput(_header(now), kpis.INTERVAL, begin, now, *series)

    def _heat_message(self, now):
        plan, heat = self._site.plan, self._warehouse.heat
        x, y = plan.point_of(0)
        size = plan.spacing, plan.passable.shape[1]
        return msg.HeatMap(_header(now), heat.seconds(now), x, y, *size, *heat.maps())

    def _tell_stations(self):
        """At once where a person waits for what comes next, even if time stands still."""
        with self._lock:
            self._stations.publish(self._stations_message(self._shift.now))

    def _stations_message(self, now):
        message = msg.StationStates()
        message.header.stamp = rospy.Time.from_sec(now)
        elapsed = max(now - self._shift.began, 1e-9)
        message.stations = [_station_state(one, now, elapsed) for one in self._shift.stations]
        return message

    def _figures(self):
        state, wall = self._coordinator.state, clock() - self._began
        fleet = SimpleNamespace(
            robots=len(self._site.robots),
            distance_m=self._warehouse.distance_m,
            collisions=state.collisions,
            blocked=state.blocked,
            watchdog=state.watchdog,
            plan_ms=[],
            executed_over_planned=state.executed_over_planned,
            failures=self._warehouse.failures,
            people=self._warehouse.people,
        )
        figures = kpis.of_shift(self._shift, fleet, self._site.kinematics, wall)
        planning = {"p50": state.plan_p50, "p99": state.plan_p99, "max": state.plan_p99}
        return figures | {"plan_ms": planning}

    def _kpis_message(self, now):
        figures = self._figures()
        planning = figures.pop("plan_ms")
        orders = self._shift.orders.values()
        for name in ("order_turnover_s", "order_throughput_s"):
            figures[name] = msg.Quantiles(**figures[name])
        message = msg.Kpis(
            **{"availability": 1.0} | figures,
            **{f"plan_{name}": value for name, value in planning.items()},
            orders_waiting=len(self._shift.backlog),
            orders_at_stations=len(self._shift.orders) - len(self._shift.backlog),
            orders_late=sum(0 < order.due < self._shift.now for order in orders),
            stock_level=self._shift.inventory.level,
        )
        message.header.stamp = rospy.Time.from_sec(now)
        return message


def tell_end(error):
    """Why there is no shift, to those who listen to notices."""
    notices = _publisher("/warehouse/notices", msg.Notices)
    notices.publish(msg.Notices(notices=[f"no shift runs: {error}"]))
    sleep(FAREWELL)


def _pause():
    """Until it is worth while to look again."""
    # Whoever goes on looks at the time itself.
    with contextlib.suppress(rospy.ROSTimeMovedBackwardsException):
        rospy.sleep(CYCLE)


def _stored_order(row, lines):
    """An OrderStatus of rows of the database."""
    return _order_status(row, row.id, lines)


def _order(order):
    """An OrderStatus of an Order."""
    return _order_status(order, order.order_id, order.lines)


def _order_status(order, order_id, lines):
    return msg.OrderStatus(
        order_id=order_id,
        reference=order.reference,
        state=order.state,
        station=order.station,
        priority=order.priority,
        created=order.created,
        due=order.due,
        completed=order.completed or 0.0,
        lines=[msg.OrderLine(line.sku, line.quantity) for line in lines],
        picked=[line.picked for line in lines],
    )


def _place(one):
    """A StockPlace of a Bin, or of its row in the database."""
    return msg.StockPlace(one.item, one.unit, one.sku, one.quantity, one.reserved, one.capacity)


def _header(now):
    return Header(stamp=rospy.Time.from_sec(now))


def _publisher(topic, kind):
    return rospy.Publisher(topic, kind, latch=True, queue_size=1)


def _queued(topic, kind):
    return rospy.Publisher(topic, kind, queue_size=10000)


def _station_state(station, now, elapsed):
    here = station.here
    return msg.StationState(
        name=station.name,
        kind=station.kind,
        open=station.is_open,
        mode=station.mode,
        shelf_id=here.unit if here else 0,
        inbound=[visit.unit for visit in station.coming if visit is not here],
        orders=list(station.orders),
        slots=station.capacity,
        picks=_picks(here) if here else [],
        pieces=station.pieces,
        busy_fraction=station.busy_s / elapsed,
        waiting=station.waiting(now),
    )


def _picks(visit):
    return [
        msg.StationPick(
            pick.line.sku,
            pick.quantity,
            pick.bin.item,
            pick.line.order.order_id,
            pick.line.order.reference,
            pick.sequence,
        )
        for pick in visit.picks
    ] + [
        msg.StationPick(bundle.sku, bundle.quantity, bundle.bin.item, 0, "", bundle.sequence)
        for bundle in visit.puts
    ]
