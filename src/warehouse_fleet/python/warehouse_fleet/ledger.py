# SPDX-License-Identifier: Apache-2.0
"""What outlives a coordinator: the number of its last transport, and which are open.

It is kept in the node's parameters, and there before anybody is told of a transport: so none of a
master's coordinators gives a number twice, and each knows what the one before it has left undone.
"""

from typing import NamedTuple

import rospy

LAST, OPEN = "~last_transport", "~open_transports"
PREFIX = "transport"  # of a name, which can't begin with a digit


class Entry(NamedTuple):
    """An open transport."""

    number: int
    shelf: int
    station: str


class Ledger:
    """Of the node that is running. `last`: the highest number so far; 0: none yet."""

    def __init__(self):
        self.last = rospy.get_param(LAST, 0)
        self._open = {}
        for name, (shelf, station) in rospy.get_param(OPEN, {}).items():
            number = int(name.removeprefix(PREFIX))
            self._open[number] = Entry(number, shelf, station)

    def __iter__(self):
        return iter(sorted(self._open.values()))

    def add(self, number, shelf, station):
        """A transport has been accepted; nothing new if that is known."""
        if number in self._open:
            return
        self._open[number] = Entry(number, shelf, station)
        self.last = max(self.last, number)
        rospy.set_param(_name(number), [shelf, station])
        rospy.set_param(LAST, self.last)

    def remove(self, number):
        """It is over."""
        if self._open.pop(number, None):
            rospy.delete_param(_name(number))


def _name(number):
    return f"{OPEN}/{PREFIX}{number}"
