#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The page comes back by itself when the simulation was started again.

The test starts and ends the simulation itself, with a master of its own, at one port of the viewer.
"""

import signal
import socket
import subprocess
import unittest
from contextlib import contextmanager

import rostest
from rostest_support.browser import browser
from rostest_support.node_test import PATIENCE, wait_until


def free_port():
    with socket.socket() as free:
        free.bind(("localhost", 0))
        return free.getsockname()[1]


def answers(port):
    with socket.socket() as visitor:
        return visitor.connect_ex(("localhost", port)) == 0


@contextmanager
def simulation(port, size):
    """A warehouse with the viewer at that port."""
    arguments = [f"viewer_port:={port}", f"size:={size}"]
    command = ["roslaunch", "--sigint-timeout=3", "--sigterm-timeout=1", "-p", str(free_port())]
    process = subprocess.Popen(
        [*command, "warehouse_sim", "warehouse.launch", *arguments], stdout=subprocess.DEVNULL
    )
    try:
        yield
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()


class ViewerRestart(unittest.TestCase):
    def test_comes_back(self):
        port = free_port()
        with browser(PATIENCE) as page:
            with simulation(port, "small"):
                wait_until(lambda: answers(port), "the viewer")
                page.open(f"http://localhost:{port}/")
                page.until("page.world.scene.robots.length === 4")
                page.until("document.getElementById('link').dataset.state === 'live'")
            page.until("document.getElementById('link').dataset.state === 'away'")
            self.assertTrue(page.read("document.getElementById('pause').disabled"))
            with simulation(port, "medium"):
                page.until("page.world.scene.robots.length === 20")
                page.until("document.getElementById('link').dataset.state === 'live'")


if __name__ == "__main__":
    rostest.rosrun("warehouse_tests", "viewer_restart", __name__)
