# SPDX-License-Identifier: Apache-2.0
"""The master as a ROS node: robots behind a broker take the commands of a running warehouse.

Commands come by the topics that the world listens to; it leaves those to robots that are elsewhere
to this node, and shows where they are by /warehouse/shadows.
"""

import math
import time
from collections.abc import Callable
from queue import Empty, SimpleQueue

import rospy

from warehouse_client.engine import Engine, EngineError
from warehouse_client.message_check import subscribe
from warehouse_client.services import is_offered
from warehouse_client.warehouse import WarehouseClient
from warehouse_layout.message_enums import EventKind as Kind
from warehouse_layout.message_enums import FailureKind, RobotMode
from warehouse_layout.models import models
from warehouse_msgs.msg import (
    ClosedZones,
    Event,
    FleetState,
    Scenery,
    TransportEvent,
    Vda5050,
)
from warehouse_msgs.srv import SetRobotMode
from warehouse_vda5050.broker_topic import BrokerTopic, masters_message
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.master.commands import Command
from warehouse_vda5050.master.fleet import RemoteFleet
from warehouse_vda5050.master.onboarded_file import OnboardedFile
from warehouse_vda5050.master.remote_vehicle import Happened, RemoteVehicle
from warehouse_vda5050.master.shadow import Shadow
from warehouse_vda5050.master.zone_desk import ClosedArea
from warehouse_vda5050.model import ToVehicle
from warehouse_vda5050.mqtt.master_link import FromVehicle
from warehouse_vda5050.ros.commands import CommandTopics
from warehouse_vda5050.ros.floor import grid_of, read_map
from warehouse_vda5050.ros.onboarding_desk import OnboardingDesk
from warehouse_vda5050.ros.unit_scales import UnitScales
from warehouse_vda5050.topics import Identity

SET_MODE = "warehouse/set_robot_mode"
PERIOD = 0.1  # of shadows [s, wall]
Send = Callable[[Identity, ToVehicle], None]
MODES = {True: RobotMode.AUTOMATIC, False: RobotMode.MANUAL}  # by whether the vehicle takes orders


class Master:
    """Hosts a RemoteFleet: take() gets the messages of vehicles, `send` sends those to them.

    run() alone touches the fleet; commands, which come in threads of rospy, wait for it. `file` has
    the robots. `run` is
    a word that no run before had, `broker` its broker's address as shown to people, `zones` whether
    vehicles may keep to zone sets, `poll` waits at most some seconds for messages of vehicles.
    """

    def __init__(
        self,
        file: OnboardedFile,
        warehouse: WarehouseClient,
        run: str,
        broker: str,
        zones: bool = False,
    ) -> None:
        self._robots, self._run, self._broker = file.robots(), run, broker
        self._has_zones = zones
        self._warehouse = warehouse
        self._scales = UnitScales(rospy, warehouse)
        self._fleet: RemoteFleet | None = None
        self._next_shadows = 0.0
        self._has_news = False  # since the shadows were published
        self._scenery: Scenery | None = None  # that the floor's cells were read with
        self._posted: SimpleQueue[Callable[[RemoteFleet], None]] = SimpleQueue()
        self._spawned: set[int] = set()
        self._modes: dict[int, bool] = {}
        self._shadows = rospy.Publisher("warehouse/shadows", FleetState, queue_size=10)
        self._events = rospy.Publisher("warehouse/events", Event, queue_size=1000)
        self._at_broker = BrokerTopic()
        self._set_mode = rospy.ServiceProxy(SET_MODE, SetRobotMode)
        self._numbers = {robot.number for robot in self._robots}
        CommandTopics(self._numbers, self._post_command, self._timeline)
        subscribe(rospy, "warehouse/zones", ClosedZones, self._on_zones, queue_size=1)
        subscribe(
            rospy, "warehouse/transports", TransportEvent, self._on_transport, queue_size=1000
        )

        OnboardingDesk(self._posted.put, file, warehouse, broker, self._join, self._leave)

    def _join(self, number: int) -> None:
        """Commands to a robot are this node's from now on."""
        self._numbers.add(number)

    def _leave(self, number: int) -> None:
        self._numbers.discard(number)
        self._spawned.discard(number)
        self._modes.pop(number, None)

    def take(self, identity: Identity, message: FromVehicle) -> None:
        """Takes a vehicle's message; called by poll()."""
        if self._fleet is not None:
            self._fleet.take(identity, message, time.monotonic())
            self._has_news = True

    def run(self, send: Send, poll: Callable[[float], None]) -> None:
        """Serves until ROS shuts down."""
        fleet = self._fleet = RemoteFleet(
            self._robots, self._grid(), self._run, self._has_zones, self._scales.measure
        )
        while not rospy.is_shutdown():
            poll(PERIOD / 4)
            self._take_posted(fleet)
            for identity, message in fleet.messages(time.monotonic()):
                send(identity, message)
            if time.monotonic() >= self._next_shadows:
                self._next_shadows = time.monotonic() + PERIOD
                self._follow_floor(fleet)
                self._show(fleet)
            elif self._has_news:  # what is released to a vehicle waits for where it is
                self._publish_shadows(fleet)
            self._publish_events(fleet.take_events())
            self._at_broker.update(lambda: self._message(fleet))
        self._show_silence(fleet)

    # --- in

    def _post_command(self, kiva_id: int, command: Command) -> None:
        self._posted.put(lambda fleet: fleet.command(kiva_id, command))

    def _on_zones(self, message: ClosedZones) -> None:
        areas = tuple(
            ClosedArea(z.zone_id, z.x_min, z.y_min, z.x_max, z.y_max, frozenset(z.inside))
            for z in message.zones
        )
        self._posted.put(lambda fleet: fleet.close_zones(areas))

    def _on_transport(self, event: TransportEvent) -> None:
        if event.kind == TransportEvent.ASSIGNED:
            self._posted.put(lambda fleet: fleet.expect_unit(event.kiva_id, event.shelf_id))

    def _timeline(self) -> int:
        return self._warehouse.timeline if self._warehouse.fleet is not None else 0

    def _take_posted(self, fleet: RemoteFleet) -> None:
        try:
            while True:
                self._posted.get_nowait()(fleet)
        except Empty:
            return

    def _grid(self) -> Grid:
        while not rospy.is_shutdown() and not self._warehouse.is_known:
            rospy.loginfo_once("waits for the warehouse")
            time.sleep(PERIOD)
        return grid_of(read_map())

    def _follow_floor(self, fleet: RemoteFleet) -> None:
        """Reads the floor's cells again once another scenery is published."""
        scenery = self._warehouse.scenery
        if scenery is self._scenery:
            return
        try:
            fleet.set_grid(grid_of(read_map()))
        except rospy.ServiceException:
            return  # the warehouse is being built or ends; there is another time
        self._scenery = scenery

    # --- out

    def _message(self, fleet: RemoteFleet) -> Vda5050:
        return masters_message(fleet.vehicles, self._broker, time.monotonic())

    def _show(self, fleet: RemoteFleet) -> None:
        for shadow in fleet.shadows(time.monotonic()):
            self._ensure_there(shadow)
        self._publish_shadows(fleet)
        for vehicle in fleet.vehicles:
            self._follow_mode(vehicle)

    def _publish_shadows(self, fleet: RemoteFleet) -> None:
        self._has_news = False
        shadows = fleet.shadows(time.monotonic())
        there = [shadow for shadow in shadows if shadow.kiva_id in self._spawned]
        if there:
            self._shadows.publish(message_of(there))

    def _show_silence(self, fleet: RemoteFleet) -> None:
        """Leaves the shadows as obstacles: the robots are still where they were seen last."""
        radio = 1 << FailureKind.RADIO_LOST
        left = [
            Shadow(**{**vars(shadow), "failures": shadow.failures | radio})
            for shadow in fleet.shadows(time.monotonic())
        ]
        if left:
            self._shadows.publish(message_of(left))

    def _ensure_there(self, shadow: Shadow) -> None:
        """Adds the robot to the world that stands for a vehicle."""
        number = shadow.kiva_id
        if number in self._spawned:
            return
        part = models.include("kiva", number, shadow.x, shadow.y, yaw=shadow.yaw)
        try:
            with Engine(rospy) as engine:
                if part.name not in engine.names():
                    engine.spawn(models.document([part]), part.name)
        except EngineError as error:
            rospy.logwarn_throttle(10, f"kiva{number} can't be shown: {error}")
            return
        self._spawned.add(number)
        rospy.loginfo(f"kiva{number} is at {shadow.x:.2f}, {shadow.y:.2f} m")

    def _follow_mode(self, vehicle: RemoteVehicle) -> None:
        """Has the coordinator command a vehicle as long as it takes orders."""
        number, takes = vehicle.robot.number, vehicle.view.takes_orders
        if number not in self._spawned or self._modes.get(number) == takes:
            return
        if number not in self._modes and takes:
            self._modes[number] = True  # as it was added
            return
        try:
            if not is_offered(rospy, SET_MODE):
                return  # no coordinator runs
            answer = self._set_mode(number, MODES[takes])
        except (rospy.ServiceException, OSError):
            return  # it ends just now
        if answer.success:
            self._modes[number] = takes

    def _publish_events(self, events: list[Happened]) -> None:
        for event in events:
            message = Event(kind=Kind[event.kind.value], model=f"kiva{event.kiva_id}")
            message.header.stamp = rospy.Time.now()
            message.other = f"storage_unit{event.unit}" if event.unit else ""
            message.text = event.text
            self._events.publish(message)


def message_of(shadows: list[Shadow]) -> FleetState:
    """Returns shadows as the world takes them."""
    message = FleetState()
    for name in vars(shadows[0]):
        setattr(message, name, [getattr(shadow, name) for shadow in shadows])
    message.yaw = [math.remainder(yaw, math.tau) for yaw in message.yaw]
    return message
