# SPDX-License-Identifier: Apache-2.0
"""The coordinator as a ROS node: the fleet of a running warehouse, driven over its topics."""

import threading
from typing import Any

import numpy as np
import rospy

from warehouse_client.pace import PaceKeeper
from warehouse_fleet.hosts.controller import Decision, FleetController, Observation
from warehouse_fleet.hosts.coordinator_messages import (
    follow_message,
    paths_message,
    state_message,
)
from warehouse_fleet.hosts.coordinator_services import CoordinatorServices, check_mode
from warehouse_fleet.hosts.event_publisher import EventPublisher
from warehouse_fleet.hosts.random_transports import RandomTransports
from warehouse_fleet.hosts.riders import Riders
from warehouse_fleet.hosts.warehouse_watch import WarehouseWatch, is_same_floor, request_map
from warehouse_fleet.hosts.zone_keeper import ZoneKeeper
from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.robots.robot_table import reports_of
from warehouse_fleet.transports.unit_map import UnitPoses
from warehouse_layout import FloorError
from warehouse_layout.floor import plan_reader
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.served_part import LeftOut, not_driven, served_part
from warehouse_layout.message_enums import RobotMode
from warehouse_msgs.msg import (
    Cancel,
    CoordinatorPaths,
    CoordinatorState,
    FleetOrders,
    FleetState,
    Lift,
    Scenery,
)
from warehouse_msgs.srv import KeepRobotMode

LATENCY, LAG = 0.4, 0.05  # from a report to what is released for it, over topics; of plans [s]
LOOKAHEAD = 0.3  # of a fast world, beyond the report that was acted upon [s]; less than LATENCY
OVERTAKEN = 1.0  # a report that is older by more comes from another world [s]
STATE_PERIOD, PATHS_PERIOD = 1.0, 0.2  # [s], simulated
NOT_YET = "the coordinator has not seen the warehouse yet"


class CoordinatorNode:
    """Hosts a FleetController: /warehouse/fleet comes in, /warehouse/fleet_orders goes out.

    A controller begins again whenever other robots or another floor are there, and with each
    timeline of the world, which a restore or a reset begins. The world keeps the modes of robots.
    `demand` "random" keeps stations busy with transports of its own, one every `exchange` seconds
    each. `lock` is held by the worker and by services.
    """

    def __init__(
        self,
        demand: str = "none",
        exchange: float = 20.0,
        seed: int = 1,
        planner: Any = None,
        threads: int = 0,
    ) -> None:
        self._demand, self._exchange, self._seed = demand, exchange, seed
        self._planner, self._threads = planner, threads
        self.lock = threading.RLock()
        self.controller: Any = None  # a FleetController, while there is a warehouse
        self.events = EventPublisher()
        self._random: RandomTransports | None = None
        self._alarm = self._left_out = ""
        self._warned: set[str] = set()  # texts that are in the log already
        self._plan_of: Scenery | None = None  # from which the plan was made
        self._ids = np.zeros(0, np.int32)
        self._timeline = 0  # of the world, as reports have it
        self._kept = np.zeros(0, np.uint8)  # the robots' modes, as the world keeps them
        self._next_state = self._next_paths = 0.0
        self._pace = PaceKeeper(LOOKAHEAD)
        publish = rospy.Publisher
        self._ordering = publish("warehouse/fleet_orders", FleetOrders, queue_size=1000)
        self._state = publish("warehouse/coordinator", CoordinatorState, latch=True, queue_size=1)
        self._paths = publish("warehouse/coordinator_paths", CoordinatorPaths, queue_size=1)
        self._keep_mode = rospy.ServiceProxy("gazebo/keep_robot_mode", KeepRobotMode)
        self._services = CoordinatorServices(self)
        self._riders = Riders(lambda m: self._services.set_down(m, self.yaw_of(m.kiva_id)))
        self._zones = ZoneKeeper(self)
        self._watch = WarehouseWatch()
        self._watch.begin()

    def run(self) -> None:
        """Controls the fleet until ROS shuts down."""
        while not rospy.is_shutdown():
            has_news = self._watch.news.wait(0.2)
            fleet = self._watch.fleet
            # What it lacks to begin may come after the only report while time stands still.
            if fleet is not None and (has_news or self.controller is None):
                with self.lock:
                    self._step(fleet)
                self._keep_pace(fleet)

    def _keep_pace(self, fleet: FleetState) -> None:
        if self.controller is not None:
            self._pace.acted_upon(fleet.stamp)
        else:
            self._pace.release()

    @property
    def reason(self) -> str:
        """Why there is no controller."""
        return self._alarm or NOT_YET

    def yaw_of(self, kiva_id: int) -> float:
        """Returns a robot's heading [rad] by its last report."""
        return self._watch.fleet.yaw[self._watch.fleet.kiva_id.index(kiva_id)]

    def _step(self, fleet: FleetState) -> None:
        reports, time = reports_of(fleet), fleet.stamp.to_sec()
        if not self._ensure_controller(reports, time, fleet.timeline):
            return
        controller, watch = self.controller, self._watch
        state_is_due = not self._next_state - STATE_PERIOD <= time < self._next_state
        was_gone = controller.robots.gone
        decision = controller.tick(
            Observation(
                time,
                reports,
                watch.people,
                fallen=len(watch.objects.fallen_item),
                refused=watch.take_refused(),
                rejected=watch.take_rejected(),
                units=watch.unit_poses() if state_is_due else None,
                look_at_map=watch.look_at_map,
            )
        )
        self._keep_modes(was_gone & ~controller.robots.gone, reports)
        self._order(decision)
        self._publish_events(time)
        self._zones.advance(controller, time, state_is_due)
        if time >= self._next_paths and self._paths.get_num_connections():
            self._next_paths = time + PATHS_PERIOD
            self._paths.publish(paths_message(controller))
        if state_is_due:
            self._next_state = time + STATE_PERIOD
            state = state_message(controller, watch, self._timeline, self._left_out)
            state.alarms += self._riders.alarms
            self._state.publish(state)
            self.events.fail_abandoned(time)

    # --- orders and events

    def _order(self, decision: Decision) -> None:
        """Sends a decision, for this timeline of the world alone."""
        orders = FleetOrders(timeline=self._timeline, follow=follow_message(decision.releases))
        orders.lifts = [
            Lift(Lift.CARRY if lift.up else Lift.DROP, lift.kiva_id, lift.shelf_id)
            for lift in decision.lifts
        ]
        self._send(orders, decision.cancels)
        for alarm in self._riders.advance(decision.moves, self._watch.fleet.kiva_id):
            rospy.logwarn(alarm)

    def _send(self, orders: FleetOrders, cancels: list[int]) -> None:
        orders.cancels = [Cancel(kiva_id) for kiva_id in cancels]
        if orders.follow.kiva_id or orders.lifts or orders.cancels:
            self._ordering.publish(orders)

    def _publish_events(self, time: float) -> None:
        events = self.controller.transports.take_events()
        for event in events:
            self.events.publish(event, self.controller.transports)
        if self._random:
            self._random.advance(time, events)

    # --- modes, which the world keeps

    def set_mode(self, kiva_id: int, mode: int) -> None:
        """Sets the side that commands a robot. Raises ValueError with the reason if it can't."""
        check_mode(mode)
        self.controller.check_mode(kiva_id, RobotMode(mode))
        if why := self._keep_one(kiva_id, mode):
            raise ValueError(why)
        self._send(
            FleetOrders(timeline=self._timeline), self.controller.set_mode(kiva_id, RobotMode(mode))
        )
        self._next_state = 0.0  # subscribers see it at once

    def _keep_one(self, kiva_id: int, mode: int) -> str:
        """Has the world keep a robot's mode. Returns why it does not, or an empty text."""
        try:
            answer = self._keep_mode(kiva_id, int(mode), self._timeline)
        except rospy.ServiceException as error:
            return str(error)
        if answer.success:
            self._kept[self.controller.robots.index(kiva_id)] = mode
        return answer.message

    def _keep_modes(self, back: np.ndarray, reports: np.ndarray) -> None:
        """Has the world keep the modes that have changed. It keeps those that robots which are
        `back`, (n,) bool, report."""
        robots = self.controller.robots
        for robot in np.flatnonzero(back).tolist():
            reported = reports["kiva_id"] == robots.kiva_ids[robot]
            self._kept[robot] = reports["mode"][reported][0]
        changed = (robots.mode != self._kept) & ~robots.gone
        for robot in np.flatnonzero(changed).tolist():
            self._keep_one(int(robots.kiva_ids[robot]), robots.mode[robot])

    # --- the controller of the warehouse that is there

    def _ensure_controller(self, reports: np.ndarray, time: float, timeline: int) -> bool:
        """Makes a controller for this warehouse if there is none. Returns whether it may use the
        reports."""
        if not self._watch.is_complete(timeline) or not len(reports):
            return False  # the warehouse is still to be built
        is_same = self._is_known_floor() and timeline == self._timeline
        is_same &= bool(np.isin(reports["kiva_id"], self._ids).all())
        if is_same and self.controller is not None:
            if not self.controller.is_stale(time):
                return True
            if self.controller.traffic.time - time < OVERTAKEN:
                return False
        if is_same and self._alarm:
            return False
        units = self._watch.unit_poses()
        if units is None:
            return False  # else it would begin without units, and deny that there are any
        self._timeline = timeline
        self._begin(reports, units, time)
        return self.controller is not None

    def _is_known_floor(self) -> bool:
        scenery = self._watch.scenery
        if scenery is self._plan_of:
            return True
        if self._plan_of is None or not is_same_floor(scenery, self._plan_of):
            return False
        self._plan_of = scenery
        if self.controller is not None:
            self.controller.traffic.update_map(self._watch.look_at_map())
        return True

    def _begin(self, reports: np.ndarray, units: UnitPoses, time: float) -> None:
        self._plan_of, self._ids = self._watch.scenery, reports["kiva_id"].copy()
        self._next_state = self._next_paths = time
        if self.controller is not None:
            self.controller.close()
        self.controller = self._random = None
        self._riders.forget()
        self._watch.take_refused()
        self._watch.take_rejected()
        try:
            grid = request_map()
            if not grid.data:
                return  # the floor is being built
            whole = plan_reader.of_messages(grid, self._watch.scenery)
            plan, left_out = served_part(whole)
            controller = self._controller_for(plan, time)
        except (rospy.ServiceException, FloorError) as error:
            self._give_up(str(error))
            return
        self._alarm = ""
        self.controller = controller
        self.controller.robots.mode[:] = self._kept = reports["mode"].copy()
        self.events.begin()
        self._begin_transports(whole, left_out, reports, units)
        self._zones.begin(self.controller, time)

    def _controller_for(self, plan: FloorPlan, time: float) -> FleetController:
        return FleetController(
            plan,
            self._ids,
            _measured(),
            seed=self._seed,
            planner=self._planner,
            last=self.events.ledger.last,
            takes_over_at=time,
            latency=LATENCY,
            lag=LAG,
            threads=self._threads,
        )

    def _begin_transports(
        self, whole: FloorPlan, left_out: LeftOut, reports: np.ndarray, units: UnitPoses
    ) -> None:
        transports = self.controller.transports
        transports.left_out = frozenset(left_out.stations)
        transports.update_units(units)
        self._left_out = self._leave_out(whole, left_out, reports)
        steps = not_driven(whole, left_out.steps)
        for reason in (*self.controller.plan.without_lane, self._left_out, steps):
            self._warn_once(reason)
        if self._demand == "random":
            self._random = RandomTransports(transports, self._seed, self._exchange)
        rospy.loginfo(
            f"coordinates {len(reports)} robots, {len(self.controller.plan.stations)} stations,"
            f" {len(transports.cell_of_unit)} storage units"
        )

    def _leave_out(self, plan: FloorPlan, left_out: LeftOut, reports: np.ndarray) -> str:
        """Puts robots out of service that stand where loaded ones can't come and go. Returns what
        is left out as a sentence; or an empty text."""
        robots = self.controller.robots
        out = np.isin(plan.cell_of(reports["x"], reports["y"]), left_out.cells)
        # The world keeps their modes as they are: another floor may reach them.
        shut = out & robots.automatic
        robots.mode[shut] = self._kept[shut] = RobotMode.OUT_OF_SERVICE
        units = self.controller.transports.units.out_of_reach()
        return left_out.text(plan, units, robots.kiva_ids[out].tolist())

    def _warn_once(self, text: str) -> None:
        if text and text not in self._warned:
            self._warned.add(text)
            rospy.logwarn(text)

    def _give_up(self, text: str) -> None:
        self._alarm = text
        self._warn_once(f"the fleet can't be coordinated: {text}")
        state = CoordinatorState(alarms=[text])
        state.header.stamp = rospy.Time.now()
        self._state.publish(state)


def _measured() -> Kinematics:
    """Returns the motion of the robots, as far as the realism of the world has it."""
    motion = rospy.get_param("gazebo/realism/motion", None)
    return Kinematics().measured(motion if isinstance(motion, dict) else {})
