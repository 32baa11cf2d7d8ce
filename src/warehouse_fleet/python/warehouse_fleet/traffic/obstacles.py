# SPDX-License-Identifier: Apache-2.0
"""Things on the floor that are in the way of a fleet until a person takes them away."""

PATIENCE = 15.0  # after which a person is asked for [s]


class ObstacleLog:
    """Notes since when something has stood in each cell."""

    def __init__(self) -> None:
        self._seen: dict[int, tuple[float, float]] = {}  # since, until [s]

    def note(self, cell: int, now: float, until: float) -> None:
        """Notes that something is taken to stand in a cell up to `until` [s]."""
        since, before = self._seen.get(cell, (now, now))
        self._seen[cell] = (since if before >= now else now), max(before, until)

    def lasting(self, now: float) -> set[int]:
        """Returns the cells in which something has stood for PATIENCE."""
        self._seen = {cell: seen for cell, seen in self._seen.items() if seen[1] >= now}
        return {cell for cell, seen in self._seen.items() if now - seen[0] >= PATIENCE}
