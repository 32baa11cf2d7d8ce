#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""examples/cmd_vel_robot drives a differential robot of wheels and motors behind a broker, with
odometry that is off: through the released points, to the last one, within 3 cm and 2 degrees."""

import math
import pathlib
import random
import signal
import subprocess
import sys
import threading
import time
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import Quaternion, TransformStamped
from nav_msgs.msg import Odometry
from rostest_support.node_test import call, wait_until
from rostest_support.warehouse_test import Collector, pose

from gazebo_msgs.srv import SpawnModel
from warehouse_client.pace import PaceKeeper
from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.master.commands import Follow
from warehouse_vda5050.master.fleet import RemoteFleet
from warehouse_vda5050.master.remote_vehicle import EventKind
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.mqtt.broker import OwnBroker
from warehouse_vda5050.mqtt.loop import Link, MqttLoop
from warehouse_vda5050.mqtt.master_link import MasterLink
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.topics import ABOUT_ZONES, Identity, Kind, Topics

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "unit" / "python"))
sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "unit" / "python" / "vda5050"))

import official_schemas
from paths import ROOT

WAFFLE = ROOT / "tests" / "worlds" / "robots" / "waffle.sdf"
VEHICLE = ROOT / "examples" / "cmd_vel_robot" / "vehicle.py"
WHO = Identity("example", "7")
NUMBER = 21  # of the robot for the master
NOISE = 0.02  # standard deviation of odometry: poses [m, rad], speeds [m/s, rad/s]
WANDERS = 0.05  # how fast the frame odom turns away, a radian driven or turned [rad]
PATIENCE = 60.0  # [s, wall]


def yaw_of(turned):
    return 2 * math.atan2(turned.z, turned.w)


def free_port():
    import socket

    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Sensors:
    """What a robot would tell in place of the true /bot/odom: on /bot/noisy poses that are off; on
    /bot/drifting poses in a frame that wanders, with its place in tf, which is off as well."""

    def __init__(self):
        self.random = random.Random(1)
        self.noisy = rospy.Publisher("/bot/noisy", Odometry, queue_size=1, tcp_nodelay=True)
        self.drifting = rospy.Publisher("/bot/drifting", Odometry, queue_size=1, tcp_nodelay=True)
        self.frames = tf2_ros.TransformBroadcaster()
        self.wandered = 0.0
        self.pace = PaceKeeper(0.1)  # the world waits for the sensors, as it does for the vehicle
        rospy.Subscriber("/bot/odom", Odometry, self.tell, queue_size=1, tcp_nodelay=True)

    def off(self, value):
        return self.random.gauss(value, NOISE)

    def tell(self, true):
        at, yaw = true.pose.pose.position, yaw_of(true.pose.pose.orientation)
        twist = true.twist.twist
        twist.linear.x, twist.angular.z = self.off(twist.linear.x), self.off(twist.angular.z)
        self.wandered += WANDERS * (abs(twist.linear.x) + abs(twist.angular.z)) / 30
        place = self.off(at.x), self.off(at.y), self.off(yaw)
        self.publish(self.noisy, true, place, "map")
        self.drift(true, place)
        self.pace.acted_upon(true.header.stamp)

    def drift(self, true, place):
        """map -> bot_odom is turned by what wandered, bot_odom -> bot_base by the same back."""
        c, s = math.cos(self.wandered), math.sin(self.wandered)
        x, y, yaw = place
        inner = c * x + s * y, c * y - s * x, yaw - self.wandered
        self.frames.sendTransform(
            [
                transform(true.header.stamp, "map", "bot_odom", (0.0, 0.0, self.wandered)),
                transform(true.header.stamp, "bot_odom", "bot_base", inner),
            ]
        )
        self.publish(self.drifting, true, inner, "bot_odom")

    def publish(self, topic, true, place, frame):
        drifted = Odometry(header=true.header, child_frame_id="bot_base", twist=true.twist)
        drifted.header.frame_id = frame
        drifted.pose.pose = pose(*place[:2], yaw=place[2])
        topic.publish(drifted)


def transform(stamp, parent, child, place):
    out = TransformStamped(child_frame_id=child)
    out.header.stamp, out.header.frame_id = stamp, parent
    out.transform.translation.x, out.transform.translation.y, yaw = place
    out.transform.rotation = Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
    return out


class Master(threading.Thread):
    """Our master, without a warehouse; it also checks whatever is said by the official schemas."""

    def __init__(self, port):
        super().__init__(daemon=True)
        grid = Grid(0.0, 0.0, 1.0, 8, 8)
        self.fleet = RemoteFleet([RemoteRobot(NUMBER, WHO)], grid, "test")
        self.vehicle = self.fleet.vehicles[0]
        broker, topics = BrokerSettings("localhost", port), Topics()
        self.link = MasterLink("master", [WHO], codec_for(), topics, broker, self.take)
        self.spy = Link("spy", broker, [(f"{topics.prefix}/#", 0)], self.check)
        self.faults, self.kinds, self.events = [], set(), []
        self.commands, self.ended = [], threading.Event()
        self.commands_it = True  # two masters would end each other's orders
        self.topics = topics

    def take(self, who, message):
        self.fleet.take(who, message, time.monotonic())

    def check(self, topic, payload, _retained):
        kind = self.topics.parse(topic)[1]
        self.kinds.add(kind)
        self.faults += official_schemas.faults(kind, payload)

    def run(self):
        loop = MqttLoop()
        loop.add(self.link.link), loop.add(self.spy)
        while not self.ended.is_set():
            loop.poll(0.02)
            if self.commands_it:
                self.command()
        loop.close(0.0)

    def command(self):
        while self.commands:
            self.fleet.command(NUMBER, self.commands.pop(0))
        for who, message in self.fleet.messages(time.monotonic()):
            self.link.send(who, message)
        self.events += [event.kind for event in self.fleet.take_events()]

    def follow(self, first, points, released):
        self.commands.append(Follow(5, first, tuple(points), released))


class CmdVelRobot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        where, xml = pose(1.0, 1.0), WAFFLE.read_text()
        answer = call("/gazebo/spawn_sdf_model", SpawnModel, "bot", xml, "/bot", where, "")
        assert answer.success, answer.status_message
        cls.truth = Collector("/bot/ground_truth/state", Odometry)
        cls.sensors = Sensors()
        cls.broker = OwnBroker(free_port())
        cls.master = Master(cls.broker.port)
        cls.master.start()

    @classmethod
    def tearDownClass(cls):
        cls.master.ended.set()
        cls.master.join()
        cls.broker.close()

    def start(self, odometry, *further):
        """The example's program, as doc/how-to/vda5050.md has it."""
        command = ["setpriv", "--pdeathsig", "TERM", str(VEHICLE)]
        topics = [f"odom:={odometry}", "cmd_vel:=/bot/cmd_vel"]
        floor = [f"_broker:=localhost:{self.broker.port}", "_columns:=8", "_rows:=8", "_serial:=7"]
        program = subprocess.Popen([*command, *topics, *floor, *further])
        self.addCleanup(self.stop, program)

    def stop(self, program):
        program.send_signal(signal.SIGINT)
        self.assertEqual(program.wait(20), 0)

    def at(self):
        """Where it truly is: x, y [m], yaw [rad], and how fast [m/s]."""
        last = self.truth.messages[-1]
        place = last.pose.pose.position
        return place.x, place.y, yaw_of(last.pose.pose.orientation), last.twist.twist.linear.x

    def expect(self, x, y, yaw):
        wait_until(lambda: abs(self.at()[3]) < 0.005, "the robot to stand")
        at = self.at()
        off = math.hypot(at[0] - x, at[1] - y), abs(math.remainder(at[2] - yaw, math.tau))
        print(f"stands {1000 * off[0]:.1f} mm and {math.degrees(off[1]):.2f} degrees off")
        self.assertLess(off[0], 0.03, at)
        self.assertLess(off[1], math.radians(2), at)

    def test_1_follows_what_is_released_and_no_more(self):
        master = self.master
        self.start("/bot/noisy")
        wait_until(lambda: master.vehicle.view.is_there, "the vehicle", PATIENCE)
        master.follow(0, [(1, 1), (2, 1), (3, 1), (4, 1), (4, 2), (4, 3), (3, 3)], 3)
        self.truth.first(lambda m: m.pose.pose.position.x > 1.7, PATIENCE)
        self.truth.clear()
        master.follow(0, (), 4)  # in time
        self.truth.first(lambda m: m.pose.pose.position.x > 3.3, PATIENCE)
        slowest = min(m.twist.twist.linear.x for m in self.truth.messages)
        self.assertGreater(slowest, 0.4)
        wait_until(lambda: master.vehicle.waits, "it to wait for more")
        self.expect(4, 1, 0)
        self.assertLess(max(m.pose.pose.position.x for m in self.truth.messages), 4.03)
        master.follow(0, (), 7)
        wait_until(lambda: EventKind.DONE in master.events, "the end of the path", PATIENCE)
        self.expect(3, 3, math.pi)
        self.assertEqual(master.vehicle.reached, 7)

    def test_2_localized_by_tf_it_obeys_the_drive_program(self):
        self.master.commands_it = False
        self.start("/bot/drifting", "_map_frame:=map", "_limits:={speed: 0.4}")
        program = ["rosrun", "warehouse_vda5050", "drive", "example/7", "c3_2", "c2_2"]
        done = subprocess.run(
            [*program, "--broker", f"localhost:{self.broker.port}"],
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=False,
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.expect(2, 2, math.pi)
        self.assertGreater(self.sensors.wandered, 0.2)  # by odom alone it had failed

    def test_3_all_that_was_said_fits_the_official_schemas(self):
        self.assertEqual(self.master.faults, [])
        self.assertEqual(self.master.kinds, set(Kind) - set(ABOUT_ZONES))  # of 3.0.0


if __name__ == "__main__":
    rospy.init_node("test_cmd_vel_robot")
    rostest.rosrun("warehouse_tests", "cmd_vel_robot", CmdVelRobot)
