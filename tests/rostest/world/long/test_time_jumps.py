#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Time jumps back and ahead under a fleet at work, its coordinator is killed, and people take
robots out of it: the shift goes on, robots keep their modes, and none touches another."""

import random
import time
import unittest

import numpy as np
import rospy
import rostest
from rostest_support.node_test import call, kill
from rostest_support.warehouse_test import Collector, delete, model_file, pose, spawn
from std_srvs.srv import Empty

from warehouse_msgs.msg import CoordinatorState, Event, FleetState, TransportEvent
from warehouse_msgs.srv import Checkpoint, SetRobotMode, SetRobotModeRequest, Undo

AUTOMATIC, MANUAL = SetRobotModeRequest.AUTOMATIC, SetRobotModeRequest.MANUAL
PATIENCE = 60.0  # [s, wall]
SETTLES = 10  # simulated, after which the fleet has gone over to the new time [s]
AUTOSAVE = 3.0  # an undo goes as far back as asked, or by less than so much farther [s]
WORKS = 3  # units that come to stations after each jump
MOST_REFUSED = 60  # commands of the old timeline, a jump


class Shift(unittest.TestCase):
    def setUp(self):
        self.random = random.Random(rospy.get_param("~seed"))
        self.state = Collector("/warehouse/coordinator", CoordinatorState)
        self.fleet = Collector("/warehouse/fleet", FleetState)
        self.events = Collector("/warehouse/events", Event)
        self.transports = Collector("/warehouse/transports", TransportEvent)
        self.state.first(lambda state: state.automatic == 20 and state.delivered >= 20, PATIENCE)
        self.manual, self.gone = set(), set()
        self.changed = 0.0  # simulated time of the last change of those, since the last jump [s]
        self.saved = {}  # those of each checkpoint
        self.done = []

    def test_time_jumps_ahead_by_undoing_a_reset(self):
        """What the page offers."""
        self.act(self.reset_and_undo)

    def test_whatever_happens_in_whatever_order(self):
        self.act(self.take)
        self.act(self.checkpoint)
        end = time.monotonic() + 60 * rospy.get_param("~minutes")
        actions = (
            *(self.checkpoint, self.restore, self.undo, self.reset, self.reset_and_undo),
            *(self.kill_coordinator, self.take, self.give_back, self.delete, self.bring_again),
        )
        while time.monotonic() < end:
            self.act(self.random.choice(actions))

    # What may happen.

    def act(self, action):
        name = getattr(action, "__name__", "act")
        self.done = [*self.done[-5:], name]
        self.events.clear()
        action()
        rospy.loginfo(f"{name}: manual {sorted(self.manual)}, gone {sorted(self.gone)}")
        self.holds()

    def ask(self, name, kind, *args):
        answer = call(f"/warehouse/{name}", kind, *args)
        self.assertTrue(answer.success, answer.message)

    def checkpoint(self):
        name = f"at {len(self.saved)}"
        self.ask("checkpoint", Checkpoint, name)
        self.saved[name] = self.manual.copy(), self.gone.copy()

    def restore(self):
        name = self.random.choice(sorted(self.saved))
        self.ask("restore", Checkpoint, name)
        self.manual, self.gone = (robots.copy() for robots in self.saved[name])
        self.changed = self.now()

    def undo(self):
        """Goes back as far as no robot has changed its mode."""
        most = min(20.0, self.now() - self.changed - 2 * AUTOSAVE)
        if most > 0:
            self.ask("undo", Undo, self.random.uniform(0, most))

    def reset(self):
        call("/gazebo/reset_simulation", Empty)
        self.changed = 0.0

    def reset_and_undo(self):
        before = self.changed
        if self.now() - before < AUTOSAVE:
            return
        self.reset()
        self.fleet.clear()
        self.fleet.first(lambda fleet: 8 <= fleet.stamp.to_sec() < 30, PATIENCE)
        self.ask("undo", Undo, self.now())
        self.changed = before

    def kill_coordinator(self):
        kill("/coordinator")

    def take(self):
        self.set_mode(self.any_of(self.there() - self.manual), MANUAL)

    def give_back(self):
        if self.manual:
            self.set_mode(self.any_of(self.manual), AUTOMATIC)

    def delete(self):
        idle = {
            kiva
            for kiva, shelf in zip(self.report().kiva_id, self.report().shelf_id)
            if not shelf and kiva not in self.manual
        }
        if idle and len(self.gone) < 3:
            robot = self.any_of(idle)
            self.assertTrue(delete(f"kiva{robot}").success)
            self.gone.add(robot)
            self.changed = self.now()

    def bring_again(self):
        if not self.gone:
            return
        robot = self.any_of(self.gone)
        fleet = self.report()
        far = 0.0
        while far < 2.5:  # away from all robots
            x = self.random.randint(round(min(fleet.x)), round(max(fleet.x)))
            y = self.random.randint(round(min(fleet.y)), round(max(fleet.y)))
            far = np.hypot(np.subtract(fleet.x, x), np.subtract(fleet.y, y)).min()
        self.assertTrue(spawn(f"kiva{robot}", model_file("kiva"), pose(float(x), float(y))).success)
        self.gone.discard(robot)
        self.changed = self.now()

    def set_mode(self, robot, mode):
        answer = call("/warehouse/set_robot_mode", SetRobotMode, robot, mode)
        self.assertTrue(answer.success, answer.message)
        (self.manual.add if mode == MANUAL else self.manual.discard)(robot)
        self.changed = self.now()

    # What is seen.

    def any_of(self, robots):
        return self.random.choice(sorted(robots))

    def report(self):
        """The next of the fleet."""
        return self.fleet.next(1)[0]

    def there(self):
        return set(self.report().kiva_id)

    def now(self):
        return self.report().stamp.to_sec()

    def holds(self):
        """Units go on coming to stations, robots have the modes that they were given."""
        self.state.clear()
        self.transports.clear()
        since = self.now()
        arrived = lambda events: sum(e.kind == TransportEvent.ARRIVED for e in events)  # noqa: E731
        self.transports.wait_for(lambda events: arrived(events) >= WORKS, PATIENCE)
        self.fleet.clear()
        self.fleet.first(lambda fleet: fleet.stamp.to_sec() > since + SETTLES, PATIENCE)
        state = self.state.next(1)[0]
        self.assertEqual(set(state.manual_kiva), self.manual, self.done)
        self.assertEqual(set(state.out_of_service_kiva), set(), self.done)
        self.assertEqual(state.automatic, 20 - len(self.manual) - len(self.gone), self.done)
        messages = list(self.events.messages)
        contacts = [f"{e.model} {e.text}" for e in messages if e.kind == Event.COLLISION]
        self.assertEqual(contacts, [], self.done)
        refused = [f"{e.model}: {e.text}" for e in messages if e.kind == Event.REFUSED]
        self.assertLess(len(refused), MOST_REFUSED, [*self.done, *refused[-3:]])


if __name__ == "__main__":
    rospy.init_node("jumping")
    rostest.rosrun("warehouse_tests", "jump", Shift)
