# SPDX-License-Identifier: Apache-2.0
"""A log of a shift, minute by minute, for reports, sizings and limits."""

from collections.abc import Collection, Sized
from typing import Any

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_operations.shift.context import Context
from warehouse_operations.shift.kpis import upper_bound
from warehouse_operations.shift.tally import INTERVAL
from warehouse_operations.stock.stations import WorkStation

# Counts of a minute, but `open`, the current number, and `bound`, an average over RECENT minutes.
SERIES = (
    "arrived",  # orders that came
    "completed",  # orders
    "open",  # orders that are not complete
    "pieces",
    "visits",  # units that were at picking stations
    "bound",  # pieces that the open picking stations could pick at most
    "picking_s",  # station-seconds that the pickers of open stations worked, on the average
    "replenishing_s",  # the same of replenishing stations
    "open_replenishing_s",  # station-seconds that replenishing stations were open
    "idle_s",  # robot-seconds without work
    "queue_s",  # robot-seconds before stations
    "robots_s",  # robot-seconds in all
    "metres",
)
RECENT = 15  # minutes over which the pieces picked from a unit are averaged


class MinuteLog:
    """Records each minute of a shift. series: a list for each of SERIES.

    orders: those that are not over. fleet: an IdealFleet or a WorldFleet. spacing: of the cells
    [m].
    """

    def __init__(
        self,
        context: Context,
        stations: Collection[WorkStation],
        orders: Sized,
        *,
        fleet: Any,
        kinematics: Kinematics,
        spacing: float,
    ) -> None:
        self._clock, self._tally, self._orders, self._fleet = (
            context.clock,
            context.tally,
            orders,
            fleet,
        )
        self._picking = [station for station in stations if station.picks]
        self._replenishing = [station for station in stations if not station.picks]
        self._kinematics, self._spacing = kinematics, spacing
        self.series: dict[str, list[float]] = {name: [] for name in SERIES}
        self._last = dict.fromkeys(SERIES, 0.0)
        self._next = INTERVAL  # time since the begin [s]

    def observe(self) -> None:
        """Records the minutes that are over."""
        while self._clock.now - self._clock.began >= self._next:
            self._next += INTERVAL
            self._note()

    def _note(self) -> None:
        totals = self._totals()
        for name, total in totals.items():
            self.series[name].append(round(float(total - self._last[name]), 3))
        self._last |= totals
        self.series["open"].append(len(self._orders))
        self.series["bound"].append(round(self._bound(), 3))

    def _totals(self) -> dict[str, float]:
        tally, activities, now = self._tally, self._fleet.activities(), self._clock.now
        return {
            "arrived": tally.orders_received,
            "completed": tally.orders_completed,
            "pieces": tally.items_picked,
            "visits": tally.pick_visits,
            "picking_s": sum(s.busy_s / s.most_pickers for s in self._picking),
            "replenishing_s": sum(s.busy_s for s in self._replenishing),
            "open_replenishing_s": sum(s.open_seconds(now) for s in self._replenishing),
            "idle_s": activities["idle"],
            "queue_s": activities["queue"],
            "robots_s": sum(activities.values()),
            "metres": self._fleet.distance_m,
        }

    def _bound(self) -> float:
        visits = sum(self.series["visits"][-RECENT:])
        pile_on = sum(self.series["pieces"][-RECENT:]) / max(visits, 1)
        per_hour = sum(
            upper_bound(pile_on, station.settings_now, self._kinematics, self._spacing)
            for station in self._picking
            if station.is_open and station.pickers
        )
        return per_hour * INTERVAL / 3600
