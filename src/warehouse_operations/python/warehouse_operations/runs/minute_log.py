# SPDX-License-Identifier: Apache-2.0
"""What happens in a shift, minute by minute, for reports, sizings and what limits a warehouse."""

from dataclasses import replace
from typing import TYPE_CHECKING

from warehouse_operations.shift.kpis import INTERVAL, upper_bound
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.stations import WorkStation

if TYPE_CHECKING:
    from warehouse_operations.runs.operations import Operations

# Each a count since the last minute, but `open` as it is and `bound` as it was over RECENT minutes.
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
    """Notes each minute of a shift that is over. series: a list for each of SERIES."""

    def __init__(self, ops: "Operations") -> None:
        self._ops = ops
        self.series: dict[str, list[float]] = {name: [] for name in SERIES}
        self._last = dict.fromkeys(SERIES, 0.0)
        self._next = INTERVAL  # time since the begin [s]

    def observe(self) -> None:
        """Notes the minutes that are over by now."""
        while self._ops.shift.now - self._ops.shift.began >= self._next:
            self._next += INTERVAL
            self._note()

    def _note(self) -> None:
        totals = self._totals()
        for name, total in totals.items():
            self.series[name].append(round(float(total - self._last[name]), 3))
        self._last |= totals
        self.series["open"].append(len(self._ops.shift.orders))
        self.series["bound"].append(round(self._bound(), 3))

    def _totals(self) -> dict[str, float]:
        shift, fleet = self._ops.shift, self._ops.fleet
        tally, activities = shift.tally, fleet.activities()
        picking, replenishing = shift.picking.stations, _replenishing(self._ops)
        return {
            "arrived": tally.orders_received,
            "completed": tally.orders_completed,
            "pieces": tally.items_picked,
            "visits": tally.pick_visits,
            "picking_s": sum(station.busy_s / station.most_pickers for station in picking),
            "replenishing_s": sum(one.busy_s for one in replenishing),
            "open_replenishing_s": sum(one.open_seconds(shift.now) for one in replenishing),
            "idle_s": activities["idle"],
            "queue_s": activities["queue"],
            "robots_s": sum(activities.values()),
            "metres": fleet.distance_m,
        }

    def _bound(self) -> float:
        shift, site = self._ops.shift, self._ops.site
        visits = sum(self.series["visits"][-RECENT:])
        pile_on = sum(self.series["pieces"][-RECENT:]) / max(visits, 1)
        per_hour = sum(
            upper_bound(pile_on, self._settings(station), site.kinematics, site.plan.spacing)
            for station in shift.picking.stations
            if station.is_open and station.pickers
        )
        return per_hour * INTERVAL / 3600

    def _settings(self, station: WorkStation) -> Settings:
        """Returns the settings of a station as it works now."""
        settings = self._ops.shift.settings.of(station.name)
        return replace(settings, pickers=station.pickers, piece_s=station.seconds_a_piece)


def _replenishing(ops: "Operations") -> list[WorkStation]:
    """Returns the stations that only replenish."""
    return [one for one in ops.shift.replenishing.stations if not one.picks]
