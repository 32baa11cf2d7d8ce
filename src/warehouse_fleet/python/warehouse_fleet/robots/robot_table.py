# SPDX-License-Identifier: Apache-2.0
"""What robots report, and what is known of each: arrays with one element for each robot."""

from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np

from warehouse_fleet.robots.failures import LIFTS_NOT, STANDS
from warehouse_layout.message_enums import RobotMode, State

NOWHERE = -1
AUTOMATIC, OUT_OF_SERVICE = int(RobotMode.AUTOMATIC), int(RobotMode.OUT_OF_SERVICE)

# A report, as FleetState has it: metres and radians in the frame world, batteries 0…1.
REPORT = np.dtype(
    [
        ("kiva_id", np.int32),
        ("x", np.float64),
        ("y", np.float64),
        ("yaw", np.float64),
        ("vx", np.float64),
        ("vy", np.float64),
        ("status", np.uint8),
        ("state", np.uint8),
        ("shelf_id", np.int32),
        ("path_id", np.uint32),
        ("reached", np.uint32),
        ("left", np.uint32),
        ("failures", np.uint8),
        ("charge", np.float32),
        ("mode", np.uint8),
    ]
)


# Reports by column: an array of REPORT, or its columns by name.
Reports: TypeAlias = "np.ndarray | Mapping[str, np.ndarray]"


def columns_of(fleet: Any) -> dict[str, np.ndarray]:
    """Returns the columns of REPORT in a fleet of this process, not copied: they hold until its
    world goes on. A world keeps no modes: its robots are AUTOMATIC."""
    columns = {name: getattr(fleet, name) for name in REPORT.names or () if name != "mode"}
    return columns | {"mode": np.zeros(len(columns["kiva_id"]), np.uint8)}


def reports_of(fleet: Any) -> np.ndarray:
    """Returns the reports (n,) of REPORT in an object with the arrays of FleetState."""
    out = np.zeros(len(fleet.kiva_id), REPORT)
    for name in REPORT.fields or ():
        values = getattr(fleet, name, 0)
        # rospy reads uint8[] as bytes.
        out[name] = np.frombuffer(values, np.uint8) if isinstance(values, bytes) else values
    return out


class RobotTable:
    """The state of each robot; robots are indices into `kiva_ids`. Each column has one writer.

    Requests to drive, written by the phases of Transports: `goal` and `home` (cells; a home is the
    storage place that a loaded robot may enter), `loaded`, `busy` (lifts or is served: stays).
    By what robots report, written by align() and update_health(): `gone` (deleted; another array
    once it has changed), `charge` (0…1),
    `failures` (bits as in FleetState), `broken` (it stands, or is not heard), `lifts_not`,
    `steered` (a client drives it by velocities).
    By execution, written by Traffic: `cell` (in which the robot stands, or stood last), `stands`
    (nothing released lies ahead), `waits_for` (a robot), `still_since` [s], `stalled` (it does not
    drive although it may), `stalled_since` [s], `astray` (pushed off the middle of its cell),
    `lost` (it did not find back, and is OUT_OF_SERVICE since then), `slowed_for_people`, `rides`
    (in an elevator, or in its queue).
    `mode` is written by set_mode of the controller, and by those who find that it has changed.
    """

    def __init__(self, kiva_ids: np.ndarray) -> None:
        self.kiva_ids = np.asarray(kiva_ids, np.int32)
        count = len(self.kiva_ids)
        self.goal = np.full(count, NOWHERE, np.int32)
        self.home = np.full(count, NOWHERE, np.int32)
        self.loaded = np.zeros(count, bool)
        self.busy = np.zeros(count, bool)
        self.mode = np.zeros(count, np.uint8)
        self.gone = np.zeros(count, bool)
        self.charge = np.ones(count, np.float32)
        self.failures = np.zeros(count, np.uint8)
        self.broken = np.zeros(count, bool)
        self.lifts_not = np.zeros(count, bool)
        self.steered = np.zeros(count, bool)
        self.cell = np.full(count, NOWHERE, np.int32)
        self.stands = np.zeros(count, bool)
        self.waits_for = np.full(count, NOWHERE, np.int32)
        self.still_since = np.zeros(count)
        self.stalled = np.zeros(count, bool)
        self.stalled_since = np.full(count, np.inf)
        self.astray = np.zeros(count, bool)
        self.lost = np.zeros(count, bool)
        self.slowed_for_people = np.zeros(count, bool)
        self.rides = np.zeros(count, bool)

    def __len__(self) -> int:
        return len(self.kiva_ids)

    @property
    def automatic(self) -> np.ndarray:
        """(n,) bool: robots that the fleet commands."""
        return self.mode == AUTOMATIC

    def index(self, kiva_id: int) -> int:
        """Returns the robot's index; NOWHERE if there is none of that id."""
        return next(iter(np.flatnonzero(self.kiva_ids == kiva_id).tolist()), NOWHERE)

    def align(self, reports: Reports) -> Reports:
        """Returns the reports (n,) with one element for each of `kiva_ids`, and updates `gone`.

        Robots that are gone stand nowhere (NaN) and are OUT_OF_SERVICE. Those that come back are in
        the mode that they report.
        """
        if np.array_equal(reports["kiva_id"], self.kiva_ids):
            gone = np.zeros(len(self), bool)
        else:
            gone = ~np.isin(self.kiva_ids, reports["kiva_id"])
            reports = self._spread(reports, gone)
        self.mode[gone] = OUT_OF_SERVICE
        if not np.array_equal(gone, self.gone):
            back = self.gone & ~gone
            self.mode[back] = reports["mode"][back]
            self.gone = gone
        return reports

    def _spread(self, reports: Reports, gone: np.ndarray) -> np.ndarray:
        ids = reports["kiva_id"]
        order = np.argsort(ids)
        out = np.zeros(len(self), REPORT)
        chosen = order[np.searchsorted(ids[order], self.kiva_ids[~gone])]
        for name in REPORT.names or ():
            out[name][~gone] = reports[name][chosen]
        out["kiva_id"] = self.kiva_ids
        out["x"][gone] = out["y"][gone] = np.nan
        return out

    def update_health(self, reports: Reports) -> None:
        """Updates batteries, failures and steered robots by the reports (n,)."""
        self.charge = reports["charge"].copy()
        self.failures = reports["failures"].copy()
        self.broken = (self.failures & STANDS) != 0
        self.lifts_not = (self.failures & LIFTS_NOT) != 0
        held_up = self.steered & (reports["state"] == State.BLOCKED)
        self.steered = (reports["state"] == State.STEERED) | held_up

    def send(self, robot: int, cell: int, home: int = NOWHERE) -> None:
        """Sets the cell that a robot is to go to; `home`: a storage place it may enter loaded."""
        self.goal[robot], self.home[robot] = cell, home
