# SPDX-License-Identifier: Apache-2.0
"""Robots that have ridden an elevator, until the world has set them down at the other landing."""

from collections.abc import Callable, Container, Iterable

from warehouse_fleet.traffic.elevators import Move


class Riders:
    """Has a world set robots down, and tries again with the next reports where it does not.

    set_down: has one set down; returns why that failed, or an empty text.
    """

    def __init__(self, set_down: Callable[[Move], str]) -> None:
        self._set_down = set_down
        self._waiting: dict[Move, str] = {}  # why the world does not set them down

    def forget(self) -> None:
        """Ends all rides: their warehouse or its time is another one."""
        self._waiting.clear()

    def advance(self, moves: Iterable[Move], present: Container[int]) -> list[str]:
        """Tries robots that wait and those of new `moves`, as far as their ids are `present`.
        Returns an alarm for each that begins to wait."""
        before, self._waiting = self._waiting, {}
        for move in (*before, *moves):
            if move.kiva_id in present and (why := self._set_down(move)):
                self._waiting[move] = why
        return [_alarm(*item) for item in self._waiting.items() if item[0] not in before]

    @property
    def alarms(self) -> list[str]:
        """A sentence about each robot that waits."""
        return [_alarm(*item) for item in self._waiting.items()]


def _alarm(move: Move, why: str) -> str:
    return f"kiva{move.kiva_id} does not move: it stays in its elevator ({why})"
