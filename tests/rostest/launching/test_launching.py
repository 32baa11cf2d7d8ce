#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A terminal: launching refuses what is wrong, and events tell what happens."""

import os
import shutil
import signal
import socket
import subprocess
import tempfile
import unittest
import xmlrpc.client
from pathlib import Path

import rosgraph
import rospy
import rostest
from rostest_support.node_test import PATIENCE, Robot, wait_until
from rostest_support.warehouse_test import world

WORLDS = Path(__file__).resolve().parents[2] / "worlds"


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def launch(*args):
    """(exit code, what it prints) of a roslaunch of the warehouse, one that ends by itself."""
    done = subprocess.run(
        ["roslaunch", "warehouse_sim", "warehouse.launch", "viewer:=false", *args],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=3 * PATIENCE,
        check=False,
    )
    return done.returncode, done.stdout


class Launching(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("/warehouse/create_warehouse_models", PATIENCE)

    def refused(self, *args):
        """What it says where nothing is started."""
        code, said = launch(*args)
        self.assertNotEqual(code, 0, said)
        self.assertNotIn("Traceback", said)
        self.assertNotIn("<param", said)
        self.assertNotIn("started with pid", said)
        return said

    def test_a_second_one_at_the_same_master_leaves_the_first_alone(self):
        said = self.refused("size:=medium", "rtf:=1")
        self.assertIn(f"a warehouse (small) runs at {os.environ['ROS_MASTER_URI']} already", said)
        self.assertIn("ROS_MASTER_URI=http://localhost:11312", said.rstrip().splitlines()[-1])
        self.assertEqual(rospy.get_param("/warehouse/name"), "small")
        self.assertEqual(rospy.get_param("/gazebo/rtf"), 5)
        self.assertIn("kiva4", world().model_names)
        Robot(1).do("rot", direction=1)

    def test_wrong_arguments(self):
        for args, reason in (
            (("world:=bogus",), "there is no world 'bogus'; tried"),
            (("rtf:=-1",), "rtf:=-1: a factor above 0, or 0"),
            (("rtf:=nan",), "rtf:=nan: a factor above 0, or 0"),
            (("size:=smal",), "size:=smal: one of none, empty, small"),
            (("sise:=small",), "there is no argument 'sise' (did you mean 'size'?)"),
            (("drive:=foo",), "drive:=foo: one of nothing, traction, jointed was expected"),
            (("seed:=abc",), "seed:=abc: a whole number from 0"),
            (("respawn:=maybe",), "respawn:=maybe: true or false was expected"),
        ):
            said = self.refused(*args)
            self.assertIn(reason, said)
            self.assertTrue(said.rstrip().splitlines()[-1].startswith("warehouse.launch: "), said)

    def test_a_broken_world_ends_without_a_traceback(self):
        folder = Path(tempfile.mkdtemp(prefix="für-"))
        broken = folder / "broken.sdf"
        shutil.copy(WORLDS / "invalid_no_world.sdf", broken)
        _, said = launch("-p", str(free_port()), f"world:={broken}")
        # Of no node: an interpreter that is stopped before it comes to one's code has its own.
        self.assertNotRegex(said, r'File "/[^"]*/warehouse_')
        self.assertIn(f"{broken}:", said)
        shutil.rmtree(folder)


class Events(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("/warehouse/create_warehouse_models", PATIENCE)

    def told(self, *args, out=subprocess.PIPE):
        """A process that tells events, once it hears them."""
        hearing = len(hearers())
        command = ["rosrun", "warehouse_sim", "events", *args]
        process = subprocess.Popen(command, stdout=out, stderr=subprocess.PIPE, text=True)
        wait_until(lambda: len(hearers()) > hearing, "it hears the events")
        return process

    def ended(self, process):
        """What it complains of at Ctrl-C."""
        process.send_signal(signal.SIGINT)
        return process.communicate(timeout=PATIENCE)[1]

    def test_of_one_robot_in_words(self):
        process = self.told("kiva2")
        Robot(1).do("rot", direction=1)
        Robot(2).do("rot", direction=1)
        lines = [process.stdout.readline() for _ in range(2)]
        self.assertRegex(lines[0], r"^ +\d+\.\d{3} s  kiva2 +ACCEPTED .*turn")
        self.assertRegex(lines[1], r"^ +\d+\.\d{3} s  kiva2 +DONE\b")
        self.assertEqual(self.ended(process), "")

    def test_in_colours_at_a_terminal(self):
        ours, its = os.openpty()
        process = self.told("--kind", "done", out=its)
        Robot(3).do("rot", direction=1)
        self.assertIn("\033[32mDONE", os.read(ours, 1000).decode())
        self.assertEqual(self.ended(process), "")

    def test_without_a_master_it_says_so(self):
        environment = os.environ | {"ROS_MASTER_URI": f"http://localhost:{free_port()}"}
        command = ["rosrun", "warehouse_sim", "events"]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("events: no ROS master at http://localhost", done.stderr)


def hearers():
    """The nodes that the world sends events to: one that is only registered misses some."""
    uri = rosgraph.Master("/test").lookupNode("/gazebo")
    links = xmlrpc.client.ServerProxy(uri).getBusInfo("/test")[2]
    return [link[1] for link in links if link[2] == "o" and link[4] == "/warehouse/events"]


if __name__ == "__main__":
    rospy.init_node("test_launching")
    rostest.rosrun("warehouse_tests", "launching", __name__)
