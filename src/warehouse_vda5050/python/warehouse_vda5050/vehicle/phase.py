# SPDX-License-Identifier: Apache-2.0
"""The phases of a vehicle, and which phase may follow which."""

from enum import Enum, auto


class Phase(Enum):
    """Where a vehicle is with its order.

    from         on                                                  to
    AVAILABLE    take: the robot is taken from its commander         HELD
    HELD         start, extend: an order begins, or goes on          WORKING
    HELD         it is needed no longer, and given back              AVAILABLE
    WORKING      its nodes and actions are over                      HELD
    WORKING      begin_cancel                                        CANCELLING
    CANCELLING   it stands at the end of its path                    HELD
    CANCELLING   it stands on its path, since it is paused           HALTED
    HALTED       it stands at the end of its path                    HELD
    """

    AVAILABLE = auto()  # others may command the robot
    HELD = auto()  # the robot is taken, and no order is under way
    WORKING = auto()  # an order is under way
    CANCELLING = auto()  # the order is to end at the next grid point, lifts come to their end
    HALTED = auto()  # the order was cancelled, and the robot is not at a node yet

    @property
    def is_free(self) -> bool:
        """Whether no order is under way: nodes and actions are over, or there never was one."""
        return self in (Phase.AVAILABLE, Phase.HELD)


FOLLOWS: dict[Phase, frozenset[Phase]] = {
    Phase.AVAILABLE: frozenset((Phase.HELD,)),
    Phase.HELD: frozenset((Phase.WORKING, Phase.AVAILABLE)),
    Phase.WORKING: frozenset((Phase.HELD, Phase.CANCELLING)),
    Phase.CANCELLING: frozenset((Phase.HELD, Phase.HALTED)),
    Phase.HALTED: frozenset((Phase.HELD,)),
}
