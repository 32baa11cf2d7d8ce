# SPDX-License-Identifier: Apache-2.0
"""The world's node in a process of its own."""

import subprocess
import threading

import rospy
from roslib.packages import find_node
from rostest_support.node_test import PATIENCE, wait_until

PARAMETERS = ("world", "rtf", "seed", "drive", "pub_clock_frequency", "model_states_frequency")
PARAMETERS += ("lockstep", "autosave", "record", "replay", "checkpoint_folder", "checkpoint_limit")
PARAMETERS += ("fleet_rate", "replay_stays")


class Node:
    """Started with these private parameters and no others.

    `most_bytes`: no file that it writes may grow beyond that, as on a full disk.
    """

    def __init__(self, most_bytes=None, **parameters):
        for name in PARAMETERS:
            if rospy.has_param(f"/gazebo/{name}"):
                rospy.delete_param(f"/gazebo/{name}")
        for name, value in parameters.items():
            rospy.set_param(f"/gazebo/{name}", value)
        program = find_node("kiva_plugin_cpp", "kiva_world_node")
        if most_bytes is not None:
            program = ["prlimit", f"--fsize={most_bytes}", *program]
        self._process = subprocess.Popen(
            program, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        self._said = []
        self._reader = threading.Thread(target=self._listen)
        self._reader.start()

    def _listen(self):
        for line in self._process.stdout:
            self._said.append(line)

    def send(self, number):
        self._process.send_signal(number)

    def says(self, *texts):
        """Waits until it has said one of them, or has ended."""
        spoken = lambda: any(text in line for line in list(self._said) for text in texts)  # noqa: E731
        wait_until(lambda: spoken() or self._process.poll() is not None, f"its saying {texts}")

    def end(self):
        """Its return code and all that it said."""
        self._process.wait(timeout=PATIENCE)
        self._reader.join()
        return self._process.returncode, "".join(self._said)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self.end()
