# SPDX-License-Identifier: Apache-2.0
"""The settings of a shift's stations."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

UNITS_LEAST, UNITS_MOST = 2, 8  # at a station or on their way to it


@dataclass(frozen=True)
class Settings:
    """The settings of stations and of requests to the fleet; defaults are RAWSim-O's."""

    slots: int = 12  # open orders a picking station
    piece_s: float = 10.0  # time from a piece to the next [s]
    piece_sd: float = 0.0  # standard deviation of piece_s from piece to piece [s]
    pick_s: float = 3.0  # part of piece_s until it is out of its bin and the unit may leave [s]
    line_s: float = 0.0  # extra for the first piece of a line: to read it, to turn to its tote [s]
    pickers: int = 1  # people or robots who pick from the same unit at the same time
    replenishes: bool = False  # a picking station at which stock is put in as well
    hours: tuple[tuple[float, float], ...] = ()  # when it is open, from the begin [h]; (): always
    breaks: tuple[tuple[float, float], ...] = ()  # no picker works, from to, from the begin [h]
    roster: tuple[int, ...] = ()  # pickers hour by hour, the last for all later ones; (): pickers
    bundle_s: float = 10.0
    units_per_station: int | None = None  # at it or on their way; None: by the number of robots
    by_station: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)  # exceptions by name

    def of(self, station: str) -> "Settings":
        """Returns the settings of the station of that name."""
        return replace(self, **self.by_station.get(station, {}))

    def pickers_at(self, hour: float) -> int:
        """Returns the number of pickers at an hour from the begin."""
        if any(begin <= hour < end for begin, end in self.breaks):
            return 0
        if not self.roster:
            return self.pickers
        return self.roster[min(int(hour), len(self.roster) - 1)]

    def shifts(self) -> list[tuple[float, int]]:
        """Returns when the number of pickers changes after the begin, with the number: (hour,
        pickers)."""
        hours = {float(hour) for hour in range(1, len(self.roster))}
        hours |= {edge for pair in self.breaks for edge in pair}
        return [(hour, self.pickers_at(hour)) for hour in sorted(hours)]

    def units_at(self, robots: int, stations: int) -> int:
        """Returns the most units at a station or on their way to it.

        Each station has its share of the robots, and requests a few more units than these fetch at
        once.
        """
        share = round(1.5 * robots / max(stations, 1))
        return self.units_per_station or min(max(share, UNITS_LEAST), UNITS_MOST)
