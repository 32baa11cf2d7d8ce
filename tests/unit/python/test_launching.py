# SPDX-License-Identifier: Apache-2.0
"""Which master a launch is about to use."""

import pytest

from warehouse_sim.launching import master_of

ROSLAUNCH = ["/usr/bin/python3", "/usr/bin/roslaunch"]


@pytest.mark.parametrize("port", [["-p", "4711"], ["-p4711"], ["--port", "4711"], ["--port=4711"]])
def test_the_port_that_roslaunch_was_given(port):
    line = [*ROSLAUNCH, "warehouse_sim", "warehouse.launch", *port, "size:=large"]
    assert master_of(line, {"ROS_MASTER_URI": "http://robots:11311"}) == "http://localhost:4711"


def test_else_that_of_the_environment():
    line = [*ROSLAUNCH, "warehouse_sim", "warehouse.launch", "--pid=x"]
    assert master_of(line, {"ROS_MASTER_URI": "http://robots:1"}) == "http://robots:1"
    assert master_of(line, {}) == "http://localhost:11311"


def test_rostest_brings_a_master_of_its_own():
    assert master_of(["/usr/bin/python3", "/usr/bin/rostest", "roslaunch.test"], {}) is None
