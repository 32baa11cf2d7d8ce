# SPDX-License-Identifier: Apache-2.0
"""The coordinator as a ROS node: the fleet of a running warehouse, driven over its topics."""

import math
import threading
import time as clock
from types import SimpleNamespace

import numpy as np
import rosgraph
import rospy
from nav_msgs.srv import GetMap
from std_msgs.msg import Header

from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import SetModelState
from warehouse_client.unit_messages import unit_ids, unit_poses
from warehouse_fleet.failures import names_of
from warehouse_fleet.fleet_driver import square
from warehouse_fleet.ledger import Ledger
from warehouse_fleet.random_transports import RandomTransports
from warehouse_fleet.takeover import ON_ITS_WAY, Takeover
from warehouse_fleet.traffic import REPORTED, STAYS, Mode, Traffic
from warehouse_fleet.transports import ENDS, NOWHERE, Answer, Kind, Step, TransportEvent, Transports
from warehouse_fleet.waiting import DOES, Waiting
from warehouse_layout import FloorError, floor_markings
from warehouse_layout.floor_plan import CONVEYOR, FloorPlan, occupancy_of
from warehouse_layout.served_part import served_part
from warehouse_msgs.msg import (
    Cancel,
    CoordinatorPaths,
    CoordinatorState,
    Event,
    FleetFollow,
    FleetOrders,
    FleetState,
    KivaStatus,
    Lift,
    People,
    Scenery,
    StationState,
    StationStates,
    UnitStates,
    WarehouseObjects,
)
from warehouse_msgs.msg import TransportEvent as TransportEventMessage
from warehouse_msgs.srv import (
    CancelTransport,
    CancelTransportResponse,
    KeepRobotMode,
    ReleaseTransport,
    ReleaseTransportResponse,
    SetRobotMode,
    SetRobotModeResponse,
    Tow,
    TowResponse,
    Transport,
    TransportResponse,
)

LATENCY = 0.4  # from a report to what is released for it, over topics [s]
OVERTAKEN = 1.0  # a report that is older by more comes from another world [s]
CONNECTING = 5.0  # wall time that listeners of this node's events get to hear it [s]
STATE_PERIOD, PATHS_PERIOD = 1.0, 0.2  # [s], simulated
NOT_YET = "the coordinator has not seen the warehouse yet"


class Coordinator:
    """Follows /warehouse/fleet and answers with /warehouse/fleet_orders.

    It begins again whenever other robots or another floor are there, and with each timeline of the
    world, which a restore or a reset begins. The world keeps the modes of robots. `demand`
    "random" keeps stations busy with transports of its own, one every `exchange` seconds each.
    """

    def __init__(self, demand="none", exchange=20.0, seed=1, planner=None):
        self._demand, self._exchange, self._seed = demand, exchange, seed
        self._planner = planner
        self._lock = threading.RLock()  # of all below, between the worker and services
        self._traffic = self._transports = self._random = None
        self._alarm = self._left_out = ""
        self._warned = set()  # texts that are in the log already
        self._scenery = self._objects = self._units = None
        self._plan_of = None  # the Scenery that the plan was made of
        self._ids = None
        self._ledger = Ledger()
        self._abandoned = []  # transports that were open when this began, until it was told
        self._refused, self._collisions = [], 0
        self._timeline = 0  # of the world, as reports have it
        self._takeover = None
        self._kept = None  # the robots' modes, as the world keeps them
        self._orders = FleetOrders()  # that are to be sent
        self._leaving = {}  # robots taken out of the fleet: since when each is idle [s], or None
        self._next_state = self._next_paths = 0.0
        self._fleet, self._news = None, threading.Event()
        self._people = People()
        publish = rospy.Publisher
        self._ordering = publish("/warehouse/fleet_orders", FleetOrders, queue_size=1000)
        self._events = publish("/warehouse/transports", TransportEventMessage, queue_size=1000)
        self._heard_by = clock.monotonic() + CONNECTING
        self._state = publish("/warehouse/coordinator", CoordinatorState, latch=True, queue_size=1)
        self._paths = publish("/warehouse/coordinator_paths", CoordinatorPaths, queue_size=1)
        rospy.Service("/warehouse/transport", Transport, self._on_transport)
        rospy.Service("/warehouse/release_transport", ReleaseTransport, self._on_release)
        rospy.Service("/warehouse/cancel_transport", CancelTransport, self._on_cancel)
        rospy.Service("/warehouse/tow", Tow, self._on_tow)
        self._keep_mode = rospy.ServiceProxy("/gazebo/keep_robot_mode", KeepRobotMode)
        self._place = rospy.ServiceProxy("/gazebo/set_model_state", SetModelState)
        rospy.Service("/warehouse/set_robot_mode", SetRobotMode, self._on_mode)
        rospy.Subscriber("/warehouse/scenery", Scenery, self._on_scenery, queue_size=1)
        rospy.Subscriber(
            "/warehouse/objects", WarehouseObjects, self._keep, "_objects", queue_size=1
        )
        rospy.Subscriber("/warehouse/unit_states", UnitStates, self._keep, "_units", queue_size=1)
        rospy.Subscriber("/warehouse/events", Event, self._on_event, queue_size=10000)
        rospy.Subscriber("/warehouse/people", People, self._keep, "_people", queue_size=1)
        self._by_hand = frozenset()  # stations where a person works
        rospy.Subscriber("/warehouse/stations", StationStates, self._on_stations, queue_size=1)
        rospy.Subscriber("/warehouse/fleet", FleetState, self._on_fleet, queue_size=1)

    def run(self):
        """Until ROS shuts down."""
        while not rospy.is_shutdown():
            if self._news.wait(0.2):
                self._news.clear()
                with self._lock:
                    self._step(self._fleet)

    # What it hears.

    def _keep(self, message, name):
        setattr(self, name, message)

    def _on_scenery(self, message):
        """It is sent again whenever somebody begins to listen: the same floor is no news."""
        message.header = Header()
        if message != self._scenery:
            self._scenery = message

    def _on_stations(self, message):
        manual = [one.name for one in message.stations if one.mode == StationState.MANUAL]
        self._by_hand = frozenset(manual)

    def _on_fleet(self, message):
        self._fleet = message
        self._news.set()

    def _on_event(self, event):
        if event.kind == Event.COLLISION:
            self._collisions += 1
        elif event.kind == Event.REFUSED and event.model.startswith("kiva"):
            self._refused.append(event.model)

    def _on_transport(self, request):
        with self._lock:
            if self._transports is None:
                return TransportResponse(*Answer(0, False, self._alarm or NOT_YET))
            answer = self._transports.submit(
                request.shelf_id,
                request.station,
                request.x,
                request.y,
                request.then,
                request.priority,
            )
            if answer.accepted:
                self._ledger.add(answer.transport_id, request.shelf_id, request.station)
            return TransportResponse(*answer)

    def _on_release(self, request):
        with self._lock:
            if self._transports is None:
                return ReleaseTransportResponse(False, self._alarm or NOT_YET)
            return ReleaseTransportResponse(*self._transports.release(request.transport_id))

    def _on_cancel(self, request):
        with self._lock:
            if self._transports is None:
                return CancelTransportResponse(False, self._alarm or NOT_YET)
            return CancelTransportResponse(*self._transports.cancel(request.transport_id))

    def _on_mode(self, request):
        with self._lock:
            if self._traffic is None:
                return SetRobotModeResponse(False, self._alarm or NOT_YET)
            robot = self._traffic.index(request.kiva_id)
            if robot == NOWHERE:
                return SetRobotModeResponse(False, f"there is no kiva{request.kiva_id}")
            if request.mode not in list(Mode):
                text = f"mode is {request.mode}; 0 (AUTOMATIC), 1 (MANUAL) or 2 (OUT_OF_SERVICE)"
                return SetRobotModeResponse(False, text + " was expected")
            if self._traffic.gone[robot]:
                return SetRobotModeResponse(False, f"kiva{request.kiva_id} is gone")
            if why := self._keep_one(robot, request.mode):
                return SetRobotModeResponse(False, why)
            self._leaving.pop(robot, None)
            if request.mode != Mode.AUTOMATIC:
                self._leaving[robot] = None
                if not self._traffic.stands[robot]:
                    self._cancel(request.kiva_id)
                    self._order()
            self._traffic.mode[robot] = request.mode
            self._next_state = 0.0  # whoever watches sees it at once
            return SetRobotModeResponse(True, "")

    def _keep_one(self, robot, mode):
        """Has the world keep that mode of a robot. Why it does not, or an empty text."""
        kiva_id = int(self._traffic.kiva_ids[robot])
        try:
            answer = self._keep_mode(kiva_id, int(mode), self._timeline)
        except rospy.ServiceException as error:
            return str(error)
        if answer.success:
            self._kept[robot] = mode
        return answer.message

    def _keep_modes(self):
        """Has the world keep those that have changed by themselves."""
        changed = (self._traffic.mode != self._kept) & ~self._traffic.gone
        for robot in np.flatnonzero(changed).tolist():
            self._keep_one(robot, self._traffic.mode[robot])

    def _on_tow(self, request):
        with self._lock:
            if self._traffic is None:
                return TowResponse(False, self._alarm or NOT_YET)
            try:
                cell = self._transports.refuge(request.kiva_id)
            except ValueError as error:
                return TowResponse(False, str(error))
            robot = self._traffic.index(request.kiva_id)
            self._traffic.shut(cell, self._traffic.time + STAYS)  # until it is seen there
            state = ModelState(model_name=f"kiva{request.kiva_id}", reference_frame="world")
            state.pose.position.x, state.pose.position.y = map(
                float, self._traffic.plan.point_of(cell)
            )
            yaw = square(self._fleet.yaw[robot])
            state.pose.orientation.z, state.pose.orientation.w = (
                math.sin(yaw / 2),
                math.cos(yaw / 2),
            )
        try:
            answer = self._place(state)
        except rospy.ServiceException as error:
            return TowResponse(False, str(error))
        return TowResponse(answer.success, "" if answer.success else answer.status_message)

    # What it does.

    def _end_paths(self, report, time):
        """Ends the paths on which robots that left the fleet wait: one that was sent to a robot
        just before its cancellation may have come to it after that."""
        for robot, idle_since in list(self._leaving.items()):
            if report.status[robot] != KivaStatus.STATUS_IDLE:
                self._leaving[robot] = None
                if report.state[robot] == KivaStatus.STATE_WAITING:
                    self._cancel(int(self._traffic.kiva_ids[robot]))
            elif idle_since is None:
                self._leaving[robot] = time
            elif time - idle_since > ON_ITS_WAY:
                del self._leaving[robot]

    def _step(self, fleet):
        report = SimpleNamespace(
            **{name: _array(getattr(fleet, name)) for name in ("kiva_id", "mode", *REPORTED)}
        )
        time = fleet.stamp.to_sec()
        if not self._is_known(report, time, fleet.timeline):
            return
        traffic, transports = self._traffic, self._transports
        report = self._align(report)
        self._take_refusals()
        if self._is_new_state(time):
            self._see_units()
            # Paths that somebody gave out before end where robots can stop.
            for kiva_id in traffic.kiva_ids[traffic.inherited(report)]:
                self._cancel(int(kiva_id))
            self._end_paths(report, time)
        traffic.observe(time, report)
        if traffic.takes_over:
            self._takeover.advance(time, report)
        self._keep_modes()
        traffic.see_people(self._people)
        traffic.see_fallen(len(self._objects.fallen_item))
        if traffic.wants_map:
            self._see_map()
        if not traffic.takes_over:
            transports.advance(report)
        self._orders.follow = _follow(traffic.releases())
        self._order()
        events = transports.take_events()
        for event in events:
            self._tell(event)
        if self._random:
            self._random.advance(time, events)
        if time >= self._next_paths and self._paths.get_num_connections():
            self._next_paths = time + PATHS_PERIOD
            self._paths.publish(self._paths_message(time))
        if self._is_new_state(time):
            self._next_state = time + STATE_PERIOD
            self._state.publish(self._state_message(time))
            if self._abandoned and self._is_heard():
                self._tell_abandoned(time)

    def _tell(self, event):
        if event.kind == Kind.RECEIVED:
            self._ledger.add(event.transport_id, event.shelf_id, event.station)
        self._events.publish(_event_message(event))
        # One that was cancelled with its unit lifted is over when that is stored.
        is_cancelled = event.kind == Kind.CANCELLED and event.transport_id not in self._transports
        if event.kind in ENDS or is_cancelled:
            self._ledger.remove(event.transport_id)

    def _tell_abandoned(self, time):
        """Whoever has asked for transports of a coordinator that is no more is to know of it."""
        for entry in self._abandoned:
            text = "the coordinator began anew"
            self._tell(TransportEvent(time, entry.number, Kind.FAILED, 0, *entry[1:], text))
        self._abandoned = []

    def _is_heard(self):
        """Whether all who listen to its events are connected, as far as they still live."""
        if clock.monotonic() > self._heard_by:
            return True
        listening = rosgraph.Master(rospy.get_name()).getSystemState()[1]
        topic = self._events.resolved_name
        wanted = sum(len(nodes) for name, nodes in listening if name == topic)
        return self._events.get_num_connections() >= wanted

    def _is_new_state(self, time):
        return not self._next_state - STATE_PERIOD <= time < self._next_state

    def _is_known(self, report, time, timeline):
        """Whether this is the warehouse that the plan is of; looks at it again if not."""
        if None in (self._scenery, self._objects, self._units):
            return False
        if self._units.timeline != timeline:
            return False  # where units stand now is not told yet
        if not len(report.kiva_id):
            return False  # the warehouse is still to be built
        if self._traffic is None and self._objects.revision != self._units.revision:
            return False  # the second message of one change is on its way
        is_same = self._is_known_floor() and self._are_known(report.kiva_id)
        is_same &= timeline == self._timeline
        if is_same and self._traffic is not None:
            if not self._traffic.is_stale(time):
                return True
            if self._traffic.time - time < OVERTAKEN:
                return False
        if is_same and self._alarm:
            return False
        self._timeline = timeline
        self._begin(report, time)
        return self._traffic is not None

    def _is_known_floor(self):
        """Whether the scenery is that of the plan but for what came or went: people, boxes, …"""
        scenery = self._scenery
        if scenery is self._plan_of:
            return True
        if self._plan_of is None or _floor_of(scenery) != _floor_of(self._plan_of):
            return False
        self._plan_of = scenery
        if self._traffic is not None:
            self._see_map()
        return True

    def _are_known(self, kiva_ids):
        """Some may be gone; not all, nor may there be others."""
        return len(kiva_ids) > 0 and bool(np.isin(kiva_ids, self._ids).all())

    def _see_map(self):
        try:
            self._traffic.see(occupancy_of(_map()))
        except rospy.ServiceException as error:
            rospy.logwarn(f"the floor can't be looked at: {error}")

    def _begin(self, report, time):
        self._plan_of, self._ids = self._scenery, report.kiva_id
        self._next_state = self._next_paths = time
        if self._traffic is not None:
            self._traffic.close()
        self._traffic = self._transports = self._random = None
        self._leaving.clear()
        self._refused, self._orders = [], FleetOrders()
        try:
            grid = _map()
            if not grid.data:
                return  # the floor is being built
            whole = FloorPlan.of_messages(grid, self._scenery)
            plan, left_out = served_part(whole)
        except (rospy.ServiceException, FloorError) as error:
            self._give_up(str(error))
            return
        self._alarm = ""
        self._traffic = Traffic(
            plan,
            report.kiva_id,
            seed=self._seed,
            planner=self._planner,
            latency=LATENCY,
            lag=0.05,
        )
        self._traffic.mode[:] = self._kept = report.mode.copy()
        self._takeover = Takeover(self._traffic, time)
        for cell in np.flatnonzero(plan.obstructed):
            self._traffic.shut(int(cell), time + STAYS)
        self._abandoned = list(self._ledger)
        self._transports = Transports(plan, self._traffic, self._send_lift, last=self._ledger.last)
        self._transports.left_out = frozenset(left_out.stations)
        self._see_units()
        self._left_out = self._leave_out(whole, left_out, report)
        for reason in (*plan.without_lane, self._left_out):
            self._warn_once(reason)
        if self._demand == "random":
            self._random = RandomTransports(self._transports, self._seed, self._exchange)
        rospy.loginfo(
            f"coordinates {len(report.kiva_id)} robots, {len(plan.stations)} stations,"
            f" {len(self._transports.cell_of_unit)} storage units"
        )

    def _leave_out(self, plan, left_out, report):
        """Robots that stand where no loaded one comes back from are out of service. What is left
        out, in a sentence; or an empty text."""
        traffic = self._traffic
        out = np.isin(plan.cell_of(report.x, report.y), left_out.cells)
        # The world keeps their modes as they are: another floor may reach them.
        shut = out & (traffic.mode == Mode.AUTOMATIC)
        traffic.mode[shut] = self._kept[shut] = Mode.OUT_OF_SERVICE
        return left_out.text(plan, self._transports.out_of_reach(), traffic.kiva_ids[out].tolist())

    def _warn_once(self, text):
        if text and text not in self._warned:
            self._warned.add(text)
            rospy.logwarn(text)

    def _give_up(self, text):
        self._alarm = text
        self._warn_once(f"the fleet can't be coordinated: {text}")
        state = CoordinatorState(alarms=[text])
        state.header.stamp = rospy.Time.now()
        self._state.publish(state)

    def _see_units(self):
        """Takes in where units stand."""
        objects, states = self._objects, self._units
        if objects.revision != states.revision or states.timeline != self._timeline:
            return
        self._transports.look(
            np.array(unit_ids(objects), int),
            *unit_poses(states),
            np.asarray(states.carrier) != 0,
            states.header.stamp.to_sec(),
        )

    def _take_refusals(self):
        refused, self._refused = self._refused, []
        for model in refused:
            self._traffic.refused(model)

    def _align(self, report):
        """The report as Traffic has robots, with the modes of those that are back."""
        was_gone = self._traffic.gone
        report = self._traffic.aligned(report)
        back = was_gone & ~self._traffic.gone
        self._kept[back] = self._traffic.mode[back]
        return report

    def _order(self):
        """Sends what is to be sent, for this timeline of the world alone."""
        orders, self._orders = self._orders, FleetOrders()
        if orders.follow.kiva_id or orders.lifts or orders.cancels:
            orders.timeline = self._timeline
            self._ordering.publish(orders)

    def _cancel(self, kiva_id):
        self._orders.cancels.append(Cancel(kiva_id))

    def _send_lift(self, kiva_id, shelf_id, up):
        self._orders.lifts.append(Lift(Lift.CARRY if up else Lift.DROP, kiva_id, shelf_id))

    def _state_message(self, time):
        traffic, transports = self._traffic, self._transports
        state = CoordinatorState(timeline=self._timeline)
        state.header.stamp = rospy.Time.from_sec(time)
        for name, mode in zip(("automatic", "manual", "out_of_service"), Mode):
            setattr(state, name, int(np.count_nonzero((traffic.mode == mode) & ~traffic.gone)))
        state.manual_kiva = self._ids_in(Mode.MANUAL)
        state.out_of_service_kiva = self._ids_in(Mode.OUT_OF_SERVICE)
        under_way = [t for t in transports if t.step != Step.OPEN]
        waiting = Waiting(traffic, transports, self._by_hand)
        doing = waiting.doing()
        state.doing_kiva, state.doing = list(doing), list(doing.values())
        for name in ("idle", *DOES.values()):
            setattr(state, name, state.doing.count(name))
        state.open = sum(t.step == Step.OPEN for t in transports)
        state.under_way = len(under_way)
        totals = transports.totals
        state.delivered, state.stored, state.failed = (
            totals.delivered,
            totals.stored,
            totals.failed,
        )
        if traffic.plan_seconds:
            spent = 1e3 * np.percentile(traffic.plan_seconds, (50, 99))
            state.plan_p50, state.plan_p99 = spent.tolist()
        state.executed_over_planned = totals.executed_over_planned
        state.station = list(transports.stations)
        state.queue = [transports.waiting(name) for name in state.station]
        long, state.waiting_text = map(list, zip(*waiting.long())) if waiting.long() else ([], [])
        state.waiting_kiva = traffic.kiva_ids[long].tolist()
        state.waiting_for = self._ids_of([traffic.ahead_of(robot) for robot in long])
        state.waiting_since = traffic.still_since[long].tolist()
        state.collisions, state.blocked = self._collisions, traffic.blocked
        state.watchdog = traffic.watchdog
        state.alarms = [
            f"kiva{traffic.kiva_ids[robot]}: {names_of(traffic.failures[robot])}"
            for robot in np.flatnonzero(traffic.failures)
        ]
        still = traffic.kiva_ids[traffic.stalled & ~traffic.broken].tolist()
        state.alarms += [f"kiva{kiva} does not move" for kiva in still]
        state.alarms += [
            f"kiva{kiva} was pushed and does not find back: put it straight, then set it AUTOMATIC"
            for kiva in traffic.kiva_ids[traffic.lost].tolist()
        ]
        state.alarms += waiting.for_people()
        objects = self._objects
        state.alarms += [
            f"{objects.items[item]} lies on the floor, off {objects.storage_units[unit]}"
            for item, unit in zip(objects.fallen_item, objects.fallen_from)
        ]
        state.alarms += [text for text in (traffic.alarm, self._left_out) if text]
        return state

    def _ids_in(self, mode):
        traffic = self._traffic
        return traffic.kiva_ids[(traffic.mode == mode) & ~traffic.gone].tolist()

    def _ids_of(self, robots):
        ids = self._traffic.kiva_ids
        return [int(ids[robot]) if robot != NOWHERE else 0 for robot in robots]

    def _paths_message(self, time):
        traffic = self._traffic
        message = CoordinatorPaths(stamp=rospy.Time.from_sec(time))
        cells = []
        for robot in np.flatnonzero(traffic.mode == Mode.AUTOMATIC):
            held, planned = traffic.paths(robot)
            waits_for = traffic.waits_for[robot]
            if len(held) + len(planned) < 2 and waits_for == NOWHERE:
                continue
            message.kiva_id.append(int(traffic.kiva_ids[robot]))
            message.released.append(len(held))
            message.planned.append(len(planned))
            message.waits_for += self._ids_of([waits_for])
            for name, at in zip(("goal_x", "goal_y"), self._point_of(traffic.goal[robot])):
                getattr(message, name).append(at)
            cells += held + planned
        x, y = traffic.plan.point_of(np.array(cells, np.int32))
        message.x, message.y = x.tolist(), y.tolist()
        return message

    def _point_of(self, cell):
        """Its centre [m]; NaN for NOWHERE."""
        if cell == NOWHERE:
            return math.nan, math.nan
        return tuple(map(float, self._traffic.plan.point_of(cell)))


def _map():
    return rospy.ServiceProxy("/warehouse/map", GetMap)().map


def _floor_of(scenery):
    """What of a Scenery a plan is made of: the floor, belts and what is painted."""
    poses = np.reshape(scenery.pose, (-1, 7)).tolist()
    fixed = [
        (name, scenery.looks[look] if floor_markings.is_name(name) else None, pose)
        for name, look, pose in zip(scenery.models, scenery.model_look, poses)
        if name.startswith(CONVEYOR) or floor_markings.is_name(name)
    ]
    return scenery.floor, scenery.grid_spacing, fixed


def _array(field):
    """An array of a message; those of bytes come as such."""
    return np.frombuffer(field, np.uint8) if isinstance(field, bytes) else np.asarray(field)


def _follow(releases):
    """A FleetFollow of what Traffic releases."""
    return FleetFollow(*(column.tolist() for column in releases))


def _event_message(event):
    message = TransportEventMessage(
        transport_id=event.transport_id,
        kind=event.kind,
        kiva_id=event.kiva_id,
        shelf_id=event.shelf_id,
        station=event.station,
        text=event.text,
    )
    message.header.stamp = rospy.Time.from_sec(event.stamp)
    return message
