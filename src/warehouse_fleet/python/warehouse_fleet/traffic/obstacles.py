# SPDX-License-Identifier: Apache-2.0
"""Things on the floor that are in the way of a fleet until a person takes them away."""

PATIENCE = 15.0  # an obstacle needs a person after this duration [s]


class ObstacleLog:
    """Notes since when something has stood in each cell."""

    def __init__(self) -> None:
        self._sightings: dict[int, tuple[float, float]] = {}  # since, until [s]

    def note(self, cell: int, now: float, until: float) -> None:
        """Notes that something is taken to stand in a cell up to `until` [s]."""
        since, before = self._sightings.get(cell, (now, now))
        self._sightings[cell] = (since if before >= now else now), max(before, until)

    def lasting(self, now: float) -> set[int]:
        """Returns the cells in which something has stood for PATIENCE."""
        self._sightings = {
            cell: sighting for cell, sighting in self._sightings.items() if sighting[1] >= now
        }
        return {cell for cell, sighting in self._sightings.items() if now - sighting[0] >= PATIENCE}
