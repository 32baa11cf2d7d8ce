# SPDX-License-Identifier: Apache-2.0
"""Robots that the world does not set down after their ride: an alarm until it does."""

from warehouse_fleet.hosts.riders import Riders
from warehouse_fleet.traffic.elevators import Move
from warehouse_viewer.watch import troubles

RIDE, OTHER = Move(7, 3.0, 4.0), Move(8, 5.0, 4.0)
SENTENCE = "kiva7 does not move: it stays in its elevator (a crate stands there)"


class World:
    """Sets robots down except for those that it has a reason for."""

    def __init__(self):
        self.reasons, self.tries = {}, []
        self.riders = Riders(self._set_down)

    def _set_down(self, move):
        self.tries.append(move.kiva_id)
        return self.reasons.get(move.kiva_id, "")

    def report(self, *moves, present=(7, 8)):
        """One tick with the moves that begin in it."""
        return self.riders.advance(moves, present)


def test_one_alarm_however_often_it_is_tried():
    world = World()
    world.reasons[7] = "a crate stands there"
    assert world.report(RIDE, OTHER) == [SENTENCE]
    for _ in range(3):
        assert world.report() == [] and world.riders.alarms == [SENTENCE]
    assert world.tries == [7, 8, 7, 7, 7]


def test_the_alarm_ends_when_it_stands_there():
    world = World()
    world.reasons[7] = "a crate stands there"
    world.report(RIDE)
    world.reasons.clear()
    assert world.report() == [] and world.riders.alarms == []
    world.report()
    assert world.tries == [7, 7]


def test_the_alarm_has_the_newest_reason():
    world = World()
    world.reasons[7] = "the service does not answer"
    world.report(RIDE)
    world.reasons[7] = "a crate stands there"
    assert world.report() == [] and world.riders.alarms == [SENTENCE]


def test_who_is_gone_or_in_another_warehouse_is_forgotten():
    for ends in (lambda w: w.report(present=(8,)), lambda w: w.riders.forget()):
        world = World()
        world.reasons[7] = "a crate stands there"
        world.report(RIDE)
        ends(world)
        assert world.riders.alarms == []
        world.report()
        assert world.tries == [7]


def test_pages_know_the_alarm_as_one_of_that_robot():
    trouble = troubles.of_sentence(SENTENCE)
    assert (trouble.kind, trouble.subject) == ("ROBOT_STALLED", "kiva7")
