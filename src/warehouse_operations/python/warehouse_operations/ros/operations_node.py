# SPDX-License-Identifier: Apache-2.0
"""Orders and stock as a ROS node: a shift over the coordinator of a running warehouse."""

import threading
from collections.abc import Callable
from time import monotonic as clock
from time import sleep, time_ns
from typing import Any

import rospy
from sqlalchemy.engine import Engine

from warehouse_client import identity
from warehouse_client.build_transaction import is_building
from warehouse_client.coordinator import CoordinatorClient
from warehouse_client.pace import PaceKeeper, wait_beyond
from warehouse_client.unit_messages import unit_ids
from warehouse_client.warehouse import WarehouseClient
from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import LayoutFile
from warehouse_layout.floor.served_part import served_part
from warehouse_msgs import msg
from warehouse_operations.fleets import measured
from warehouse_operations.fleets.availability import Availability, RealismError, of_content
from warehouse_operations.fleets.fleet_now import FleetNow
from warehouse_operations.fleets.floor_heat import SLICES, FloorHeat
from warehouse_operations.fleets.measured import Measured
from warehouse_operations.forecast.workers import BUDGET
from warehouse_operations.policies import Policies
from warehouse_operations.ros import operation_messages
from warehouse_operations.ros.fleet_log import FleetLog
from warehouse_operations.ros.fleet_messages import fleet_now
from warehouse_operations.ros.forecast_service import ForecastService
from warehouse_operations.ros.operation_messages import SHOWN, header
from warehouse_operations.ros.remote_transports import RemoteTransports
from warehouse_operations.ros.shift_services import ShiftServices
from warehouse_operations.runs import layout_site
from warehouse_operations.runs.opening import open_shift
from warehouse_operations.shift.changes import ChangeJournal
from warehouse_operations.shift.shift import Shift
from warehouse_operations.shift.tally import INTERVAL
from warehouse_operations.shift.tasks import KEPT
from warehouse_operations.stock.demand import DemandError
from warehouse_operations.stock.site import Site
from warehouse_operations.stock.units_by_id import UnitCells
from warehouse_operations.store import stored
from warehouse_operations.store.database import Database

FAREWELL = 1.0  # time for subscribers to get the last notice [s, wall]
CYCLE = 0.1  # between two steps of the shift [s]
LOOKAHEAD = 0.3  # of a fast world, beyond the last step of the shift [s]
# Roles of policies of a shift with its own fleet; here another node drives.
OF_THE_COORDINATOR = ("storage", "robots", "idle", "charging")
STATIONS_PERIOD, KPIS_PERIOD = 1.0, 10.0  # [s], simulated


class OperationsNode:
    """Runs a shift and serves it.

    database: a URL, or the path of an SQLite file. orders: see open_shift. forecast_every and
    forecast_seconds: every and budget of ForecastService [s]. Raises what open_shift raises, and
    rospy.ROSInterruptException where ROS shuts down meanwhile.
    """

    def __init__(
        self,
        database: str,
        orders: str = "fill",
        policies: Policies | None = None,
        seed: int = 1,
        forecast_every: float = 0.0,
        forecast_seconds: float = BUDGET,
    ) -> None:
        self._lock = threading.RLock()  # of the shift, between the loop and services
        self._log = FleetLog()
        self._warned: set[str] = set()
        self._last_step = clock()
        self._pace = PaceKeeper(LOOKAHEAD)
        self._warehouse = WarehouseClient(rospy, self._on_fleet)
        self._coordinator = CoordinatorClient(rospy)
        self._notices = _publisher("notices", msg.Notices)
        self._kpis = _publisher("kpis", msg.Kpis)
        self._throughput = _publisher("throughput", msg.Throughput)
        self._heat = _publisher("heat", msg.HeatMap)
        self._orders = _queued("order_changes", msg.OrderStatuses)
        self._stock = _queued("stock_changes", msg.StockPlaces)
        self._events = _queued("order_events", msg.OrderEvent)
        self._chosen: dict[str, Any] = {"orders": orders, "seed": seed}
        self._own_policies = policies or Policies()
        self._wait_for_warehouse()
        self._database = Database(database)
        self._begin()
        ShiftServices(self)
        self._forecasts = ForecastService(self, forecast_every, forecast_seconds)
        # Published last: a node that has received this topic finds all services.
        self._stations = _publisher("stations", msg.StationStates)

    @property
    def shift(self) -> Shift:
        """The shift that runs now."""
        return self._shift

    @property
    def engine(self) -> Engine:
        """The engine of the database."""
        return self._database.engine

    # What a forecast needs of a node.

    @property
    def site(self) -> Site:
        """The warehouse of the shift."""
        return self._site

    @property
    def orders_text(self) -> str:
        """What orders come."""
        return str(self._chosen["orders"])

    @property
    def availability(self) -> Availability:
        """What keeps robots from work, by the realism of the world; nothing where that is
        unknown."""
        content = rospy.get_param("gazebo/realism", None)
        try:
            return of_content(content) if content else Availability()
        except RealismError:
            return Availability()

    def _measured(self) -> Measured:
        """What the realism of the world says of motion and service; nothing where it is invalid,
        which the world says."""
        try:
            return measured.of_content(rospy.get_param("gazebo/realism", None) or {})
        except RealismError as error:
            rospy.logwarn(f"motion and service stay as they are: {error}")
            return Measured()

    @property
    def elsewhere(self) -> tuple[str, ...]:
        """Roles of policies that the coordinator has."""
        return OF_THE_COORDINATOR

    @property
    def last_step(self) -> float:
        """When the shift was advanced last [s, wall]."""
        return self._last_step

    @property
    def lock(self) -> threading.RLock:
        """The lock of the shift."""
        return self._lock

    def with_fleet(self) -> tuple[Shift, FleetNow]:
        """Returns the shift and its fleet; call it with the lock."""
        shift, state = self._shift, self._coordinator.state
        robot_of = self._transports.robot_of
        return shift, fleet_now(shift, self._site.plan, self._warehouse, state, robot_of)

    def _begin(self) -> None:
        """Begins a shift that continues the warehouse of the database."""
        now = rospy.get_time()
        self._timeline = self._warehouse.timeline
        file = self._layout_file()
        self._site = self._read_site()
        if file:
            self._site = layout_site.of_file(self._site, file)
        self._site = self._measured().at(self._site)
        self._policies = self._own_policies
        if file:
            self._policies = layout_site.merged(file, self._own_policies)
        self._transports = RemoteTransports(self._coordinator)
        heat = FloorHeat(self._site.plan, now)
        since = max(0.0, (now // INTERVAL + 1 - SHOWN) * INTERVAL)
        with self._database.reading():
            left = stored.transports_left(self.engine)
            heat.restore(stored.heat(self.engine, now))
            self._before = stored.throughput(self.engine, now, since)
            reports = stored.reports(self.engine, KEPT)
        self._transports.release_left(*left)
        self._shift = self._open_shift(now)
        self._shift.on_order_event = self._publish_order_event
        # Task numbers on pages of an earlier run must not be reused [ms, wall].
        self._shift.task_numbers.number_from(time_ns() // 10**6)
        self._shift.tasks.remember(reports)
        self._shift.notices.on_change = self._publish_notices
        idle = ", ".join(role for role in OF_THE_COORDINATOR if role in self._policies.choices)
        if idle:
            self._shift.notices.add(
                f"policies: the coordinator decides {idle} by itself, whatever is chosen"
            )
        self._publish_notices()
        # Delegates other attributes to the inner journal, which its type does not show.
        changes: Any = ChangeJournal(self._shift.journal)
        self._changes = self._shift.journal = changes
        self._floor_heat = heat
        self._log.begin(heat)
        self._keep_heat(SLICES)  # by the times of this run
        self._began = clock()
        self._next_stations = self._next_kpis = now
        rospy.loginfo(
            f"{len(self._site.units)} storage units, {len(self._site.items)} bins, "
            f"{len(self._shift.orders)} orders to go on with"
        )

    def _layout_file(self) -> LayoutFile | None:
        """Returns the layout file of which the warehouse was built; None without one."""
        path = identity.layout(rospy)
        return layout_file.read(path) if path else None

    def _read_site(self) -> Site:
        plan, _ = served_part(self._warehouse.plan())
        return Site(
            plan,
            self._warehouse.robot_cells(plan),
            self._warehouse.unit_cells(plan),
            self._warehouse.items(),
            rospy.get_param("warehouse/name", ""),
        )

    def _open_shift(self, now: float) -> Shift:
        """Returns a Shift, without orders if their file has faults."""

        def begin(orders: str) -> Shift:
            chosen: dict[str, Any] = self._chosen | {"orders": orders, "policies": self._policies}
            return open_shift(
                self._site, self._transports, database=self._database, now=now, **chosen
            )

        try:
            return begin(self._chosen["orders"])
        except DemandError as error:
            shift = begin("none")
            first, *more = str(error).splitlines()
            text = f"{first} (and {len(more)} more)" if more else first
            shift.notices.add(f"no orders come from the file: {text}")
            return shift

    # The loop.

    def run(self) -> None:
        """Runs until ROS shuts down."""
        while not rospy.is_shutdown():
            with self._lock:
                now = rospy.get_time()
                if now < self._shift.now or self._warehouse.timeline != self._timeline:
                    self._begin_again(now)
                else:
                    self._step(now)
            self._pace.acted_upon(rospy.Time.from_sec(now))
            # From `now` on: the world may have passed it, and wait for this shift before it has
            # passed a cycle more.
            wait_beyond(now, CYCLE)

    def _begin_again(self, now: float) -> None:
        """Begins another shift after the world was reset, restored or undone.

        It keeps stock and orders, and drops the transports.
        """
        rospy.logwarn(f"the world jumped from {self._shift.now:g} s to {now:g} s")
        self._shift.end(self._figures())
        self._shift.journal.flush()
        self._pace.release()  # its warehouse may take a while to build
        self._wait_for_warehouse()
        self._begin()

    def close(self) -> None:
        """Ends a forecast and writes pending rows to the database. Raises DatabaseError."""
        self._forecasts.close()
        with self._lock:
            self._shift.end(self._figures())
            self._database.close()

    def _wait_for_warehouse(self) -> None:
        while not (
            self._warehouse.is_known_at(rospy.get_time())
            and self._is_coordinated()
            and not is_building(rospy)
        ):
            if rospy.is_shutdown():
                raise rospy.ROSInterruptException("shut down before there was a warehouse")
            rospy.rostime.wallsleep(CYCLE)  # fast time may stand, since it awaits this node

    def _is_coordinated(self) -> bool:
        state = self._coordinator.state
        if state is None or not len(state.station):
            return False
        return state.timeline == self._warehouse.timeline

    def _step(self, now: float) -> None:
        if now >= self._next_stations:
            standing = self._warehouse.standing_units(self._site.plan)
            self._shift.floor.cells = UnitCells(standing)
            if self._warehouse.is_known:
                self._shift.update_units(set(unit_ids(self._warehouse.objects)))
        self._shift.fallen.update(self._warehouse.fallen_items)
        self._last_step = clock() if now > self._shift.now else self._last_step
        self._shift.advance(now)
        self._publish_changes(now)
        if now >= self._next_stations:
            self._next_stations = now + STATIONS_PERIOD
            self.publish_stations()
        if now >= self._next_kpis:
            self._next_kpis = now + KPIS_PERIOD
            self._publish_figures(now)
            self._keep_heat(slices=1)
        self._forecasts.keep_up(now)

    def carry_out(self, act: Callable[[Shift], Any]) -> Any:
        """Calls act(shift), waits until the database has its effects, and returns its result."""
        with self._lock:
            shift = self._shift
            answer = act(shift)
            shift.commit()
        shift.journal.flush()
        return answer

    def _on_fleet(self, before: msg.FleetState | None, message: msg.FleetState) -> None:
        self._log.update(before, message, self._warehouse.people)

    def _keep_heat(self, slices: int) -> None:
        for kept in self._floor_heat.kept(slices):
            self._shift.journal.heat(*kept)

    def _figures(self) -> dict[str, Any]:
        state, wall = self._coordinator.state, clock() - self._began
        fleet = operation_messages.fleet_figures(len(self._site.robots), state, self._log)
        figures = self._shift.figures(fleet, self._site.kinematics, wall)
        return figures | {"plan_ms": operation_messages.planning(state)}

    # Topics.

    def publish_stations(self) -> None:
        """Publishes the stations at once, for a person who waits for the next task.

        Time may stand still meanwhile.
        """
        with self._lock:
            shift = self._shift
            self._stations.publish(operation_messages.station_states(shift.stations, shift.now))

    def _publish_order_event(self, *event: Any) -> None:
        self._events.publish(operation_messages.order_event(self._shift.now, *event))

    def _publish_notices(self) -> None:
        for text in set(self._shift.notices) - self._warned:
            rospy.logwarn(text)
        self._warned = set(self._shift.notices)
        self._notices.publish(msg.Notices(header(self._shift.now), list(self._shift.notices)))

    def _publish_changes(self, now: float) -> None:
        """Publishes orders and bins as they are now, if they have changed."""
        orders = [operation_messages.order_status(order) for order in self._changes.take_orders()]
        if orders:
            self._orders.publish(msg.OrderStatuses(header(now), orders))
        places = [operation_messages.stock_place(bin_) for bin_ in self._changes.take_bins()]
        if places:
            self._stock.publish(msg.StockPlaces(header(now), places))

    def _publish_figures(self, now: float) -> None:
        shift, plan, heat = self._shift, self._site.plan, self._floor_heat
        values, level = self._figures(), shift.inventory.level
        self._kpis.publish(operation_messages.kpis_message(values, shift.order_book, level, now))
        self._throughput.publish(operation_messages.throughput(shift.tally, self._before, now))
        self._heat.publish(operation_messages.heat_map(heat, plan, now))


def publish_end(error: Exception) -> None:
    """Publishes an error that ended or prevented the shift as its last notice."""
    notices = _publisher("notices", msg.Notices)
    notices.publish(msg.Notices(notices=[f"no shift runs: {error}"]))
    sleep(FAREWELL)


def _publisher(topic: str, kind: type) -> rospy.Publisher:
    return rospy.Publisher(f"warehouse/{topic}", kind, latch=True, queue_size=1)


def _queued(topic: str, kind: type) -> rospy.Publisher:
    return rospy.Publisher(f"warehouse/{topic}", kind, queue_size=10000)
