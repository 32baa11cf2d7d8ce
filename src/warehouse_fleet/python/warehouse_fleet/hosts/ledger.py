# SPDX-License-Identifier: Apache-2.0
"""Keeps what must outlive a coordinator: the number of its last transport, and the open transports.

Both are kept in the node's parameters, and are written before a transport is announced. So no two
coordinators of one ROS master give out the same number, and each coordinator knows which transports
its predecessor left open.
"""

from collections.abc import Iterator
from typing import NamedTuple

import rospy

LAST, OPEN = "~last_transport", "~open_transports"
PREFIX = "transport"  # before the number: the name of a parameter can't begin with a digit


class Entry(NamedTuple):
    """An open transport."""

    number: int
    shelf: int  # id of the storage unit
    station: str  # empty: its destination is a cell


class Ledger:
    """The open transports of the running node, iterated in ascending order of their numbers.

    `last` is the highest number given out so far, 0 before the first.
    """

    def __init__(self) -> None:
        """Reads what the parameters hold; needs rospy.init_node."""
        self.last: int = rospy.get_param(LAST, 0)
        self._open: dict[int, Entry] = {}
        for name, (shelf, station) in rospy.get_param(OPEN, {}).items():
            number = int(name.removeprefix(PREFIX))
            self._open[number] = Entry(number, shelf, station)

    def __iter__(self) -> Iterator[Entry]:
        return iter(sorted(self._open.values()))

    def add(self, number: int, shelf: int, station: str) -> None:
        """Records an accepted transport; does nothing if it is recorded already."""
        if number in self._open:
            return
        self._open[number] = Entry(number, shelf, station)
        self.last = max(self.last, number)
        rospy.set_param(_name(number), [shelf, station])
        rospy.set_param(LAST, self.last)

    def remove(self, number: int) -> None:
        """Removes a transport that has ended; does nothing if it is not recorded."""
        if self._open.pop(number, None):
            rospy.delete_param(_name(number))


def _name(number: int) -> str:
    return f"{OPEN}/{PREFIX}{number}"
