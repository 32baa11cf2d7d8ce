# SPDX-License-Identifier: Apache-2.0
"""Why robots wait, in words for a person."""

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.transports.transport_book import Step, Transport
from warehouse_fleet.transports.waiting import Waiting
from warehouse_layout.message_enums import RobotMode

NOW = 1200.0  # [s]


class Queue:
    """The part of Traffic that Waiting asks. The first of four robots is at work, each other stands
    behind the one before it, all for 20 minutes."""

    def __init__(self):
        self.time = NOW
        self.robots = RobotTable(np.arange(1, 5))
        self.robots.busy[0] = True

    def all_ahead(self):
        return np.array([NOWHERE, 0, 1, 2])


def served(robot, station):
    return Transport(1, 7, station, 0, 0, 0, step=Step.WAITING, robot=robot)


def test_a_queue_is_told_by_its_station():
    text = Waiting(Queue(), [served(0, "pick1")]).long()
    assert text == [
        (1, "in the queue of pick1 behind kiva1"),
        (2, "in the queue of pick1 behind kiva2"),
        (3, "in the queue of pick1 behind kiva3"),
    ]


def test_a_station_by_hand_is_named_instead_of_its_queue():
    waiting = Waiting(Queue(), [served(0, "pick1")], frozenset(["pick1"]))
    assert waiting.long() == []
    assert waiting.for_people() == ["pick1 has waited for a person for 20 min"]


def test_what_stands_in_the_way_is_reported():
    queue = Queue()
    queue.robots.mode[0] = RobotMode.MANUAL
    queue.robots.busy[0] = False
    waits = dict(Waiting(queue, []).long())
    assert waits[1] == "behind kiva1, which is manual"
    assert waits[2] == "behind kiva2, in a queue behind kiva1, which is manual"
    queue.robots.slowed_for_people[0] = True
    assert dict(Waiting(queue, []).long())[0] == "for people on the floor"


def brought(robot, station="pick4"):
    return Transport(robot + 1, 7, station, 0, 0, 0, step=Step.BRINGING, robot=robot)


def test_a_queue_says_which_robot_of_it_is_broken():
    queue = Queue()
    queue.robots.broken[0], queue.robots.busy[0] = True, False
    waits = dict(Waiting(queue, [brought(robot) for robot in range(4)]).long())
    assert waits == {
        0: "until it is repaired",
        1: "in the queue of pick4 behind kiva1, which is broken",
        2: "in the queue of pick4 behind kiva2, in a queue behind kiva1, which is broken",
        3: "in the queue of pick4 behind kiva3, in a queue behind kiva1, which is broken",
    }


def test_the_queue_goes_on_while_the_unit_that_was_served_leaves():
    leaves = Transport(1, 7, "pick4", 0, 0, 0, step=Step.STORING, robot=0)
    waits = dict(Waiting(Queue(), [leaves, *map(brought, range(1, 4))]).long())
    assert waits == {n: f"in the queue of pick4 behind kiva{n}" for n in (1, 2, 3)}


def test_robots_of_different_stations_share_no_queue():
    queue = Queue()
    queue.robots.broken[0] = True
    waits = dict(Waiting(queue, [brought(0, "pick1"), brought(1, "pick2")]).long())
    assert waits[1] == "behind kiva1, which is broken"


def test_each_robot_does_one_thing_and_one_that_is_gone_none():
    queue = Queue()
    queue.robots.mode[1], queue.robots.gone[2] = RobotMode.OUT_OF_SERVICE, True
    doing = Waiting(queue, [served(0, "pick1")]).doing()
    assert doing == {1: "waiting", 2: "out_of_service", 4: "idle"}
