#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A vehicle behind a broker as a robot of the fleet: the coordinator has it carry a storage unit,
among simulated robots; when it falls silent it is an obstacle, and it comes back."""

import sys
from pathlib import Path

import rosgraph
import rospy
import rostest
from rostest_support.behind_broker import NUMBER, OUT_OF_SERVICE, PATIENCE, BrokerCase, set_modes
from rostest_support.node_test import call, latched, wait_until

from warehouse_layout.message_enums import FailureKind
from warehouse_msgs.msg import CoordinatorState, Event, Rotate, TransportEvent, Vda5050
from warehouse_msgs.srv import Transport

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "unit" / "python" / "vda5050"))

from grid_robot import GridRobot

CELL_TIME = 0.3  # that the vehicle takes for a cell [s, wall]
HEARD = ("/lift", "/mov", "/movx", "/movy", "/rot")  # from the world
RADIO = 1 << FailureKind.RADIO_LOST


class MetricRobot(GridRobot):
    """A GridRobot on the cells of a Grid: its points are in metres."""

    def __init__(self, grid, cell):
        super().__init__(cell)
        self.grid, self._left = grid, CELL_TIME

    def step(self, seconds):
        self._left -= seconds
        if self._left <= 0:
            self._left = CELL_TIME
            super().step()

    def follow(self, path_id, first, points, released):
        cells = [self.grid.cell_at(*point) for point in points]
        super().follow(path_id, first, cells, released)

    def report(self):
        x, y = self.grid.position(self.cell)
        self.extra |= {"x": x, "y": y}
        return super().report()

    def lift(self, unit, up):
        self.units = {unit: self.cell} if up else {}
        super().lift(unit, up)


class VehicleCase(BrokerCase):
    """One vehicle on a free parking cell."""

    ROBOT = MetricRobot

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.behind = cls.add_vehicle(cls.ROBOT(cls.grid, cls.free_places()[0]))
        cls.start_master()

    def broken(self):
        return bool(self.row()["failures"] & RADIO)


class Master(VehicleCase):
    def test_1_it_stands_where_the_vehicle_is(self):
        wait_until(self.row, "the vehicle's shadow", PATIENCE)
        x, y = self.behind.robot.grid.position(self.behind.robot.cell)
        wait_until(lambda: (self.row()["x"], self.row()["y"]) == (x, y), "its place")
        driven_by = latched("/warehouse/vda5050", Vda5050, lambda m: bytes(m.connection) == b"\0")
        self.assertEqual((driven_by.direction, driven_by.kiva_id), (Vda5050.MASTER, (NUMBER,)))
        self.assertEqual((driven_by.manufacturer, driven_by.serial), (["acme"], ["7"]))

    def test_2_commands_that_the_world_publishes_are_heard_from_it_alone(self):
        """A client that waits for one connection has that to the world."""
        rotate = rospy.Publisher("/rot", Rotate, queue_size=1)
        wait_until(rotate.get_num_connections, "the world")
        rotate.publish(kiva_id=NUMBER, direction=Rotate.CLOCKWISE)
        why = "a vehicle behind a broker takes paths, lifts, cancel and stop; no turn"
        wait_until(lambda: why in self.texts(Event.REFUSED), "the refusal")
        _, subscribers, _ = rosgraph.Master("/test").getSystemState()
        hearing = {topic: nodes for topic, nodes in subscribers if topic in HEARD}
        self.assertEqual(hearing, {topic: ["/gazebo"] for topic in HEARD})

    def test_2_the_coordinator_has_it_carry_a_unit(self):
        self.state.first(lambda state: state.automatic == 5, PATIENCE)
        set_modes(OUT_OF_SERVICE)
        answer = call("/warehouse/transport", Transport, shelf_id=7, station="pick1", then=0)
        self.assertTrue(answer.accepted, answer.message)
        self.transports.first(lambda e: e.kind == TransportEvent.ARRIVED, PATIENCE)
        self.assertEqual(self.row()["shelf_id"], 7)
        self.assertEqual([kind for kind, *_ in self.behind.robot.events if kind != "at"], ["pick"])
        self.assertEqual(self.contacts(), [])

    def test_3_a_silent_vehicle_is_an_obstacle_until_it_is_heard(self):
        self.behind.robot.extra["heard"] = False
        wait_until(self.broken, "it is not heard")
        self.state.first(lambda state: any("kiva21" in alarm for alarm in state.alarms), PATIENCE)
        self.behind.robot.extra["heard"] = True
        wait_until(lambda: not self.broken(), "it is heard again")


if __name__ == "__main__":
    rospy.init_node("behind_a_broker")
    latched("/warehouse/coordinator", CoordinatorState)
    rostest.rosrun("warehouse_tests", "behind_a_broker", Master)
