# SPDX-License-Identifier: Apache-2.0
"""The node that makes robots vehicles: parameters in, one loop around all connections."""

import contextlib

import rospy

from warehouse_vda5050.arguments import BrokerArguments, home, own_broker, read_arguments
from warehouse_vda5050.broker_topic import BrokerTopic, vehicles_message
from warehouse_vda5050.ros import pace_check
from warehouse_vda5050.ros.fault_desk import FaultDesk, read_script
from warehouse_vda5050.vehicles import SiteSettings, Vehicles
from warehouse_vda5050.world_link import WorldLink

PERIOD = 0.05  # time between two updates [s, wall]


class VehiclesNode:
    """Raises ValueError for parameters that are wrong, RuntimeError without a broker to start."""

    def __init__(self) -> None:
        arguments: BrokerArguments = read_arguments(rospy.get_param)
        self._stack = contextlib.ExitStack()
        self._stopping = False
        script = read_script(str(rospy.get_param("~faults", "")))
        broker, self._address = own_broker(arguments, self._stack)
        settings = SiteSettings(
            str(rospy.get_param("~manufacturer", "kiva")),
            arguments.codec,
            arguments.topics,
            broker,
            float(rospy.get_param("~interval", 1.0)),
            float(rospy.get_param("~visualization", 1.0)),
            home() / "vda5050_logs",
        )
        rospy.loginfo(f"vehicles of VDA 5050 {arguments.codec.version} at {self._address}")
        pace_check.warn(pace_check.OF_MASTER)
        self._world = WorldLink()
        self._vehicles = Vehicles(self._world, settings, self._world.happened)
        self._faults = FaultDesk(self._vehicles, script)
        self._topic = BrokerTopic()

    def stop(self, *_: object) -> None:
        """Lets run() end; a handler of signals."""
        self._stopping = True

    def run(self) -> None:
        """Runs until stop(), or until the node is shut down; then gives all robots back."""
        with self._stack:
            self._stack.callback(self._vehicles.close)
            while not (self._stopping or rospy.is_shutdown()):
                self._vehicles.loop.poll(PERIOD)
                self._update()
                self._topic.update(lambda: vehicles_message(self._vehicles, self._address))

    def _update(self) -> None:
        world = self._world
        if world.read_floor() and world.grid:
            self._vehicles.set_grid(world.grid)
        self._faults.update()
        self._vehicles.update(world.sightings(), world.take_refusals(), world.silence)
