# SPDX-License-Identifier: Apache-2.0
"""Progress of a sizing: on one line of a terminal, elsewhere a line a shift."""

import sys
from typing import TYPE_CHECKING, TextIO

from warehouse_layout.cli.progress_line import ProgressLine
from warehouse_operations.sizing.point import Point, Record
from warehouse_operations.sizing.verdict import figures_of
from warehouse_operations.sizing.wish import count

if TYPE_CHECKING:
    from warehouse_operations.sizing.study import Study


class Shown:
    """Shows each shift that was simulated; a Study calls it as on_shift."""

    def __init__(self, stream: TextIO = sys.stderr) -> None:
        self._line = ProgressLine(stream)

    def __call__(self, study: "Study", point: Point, record: Record) -> None:
        """Shows a shift, and the totals so far."""
        kind = " with physics" if point.physics else ""
        in_time = 1 - figures_of(record, point.run_in)["late"]
        self._line.replace(
            f"{count(point.stations, 'station')}, {count(point.robots, 'robot')},"
            f" seed {point.seed}{kind}:"
            f" {100 * in_time:.1f} % in time; {study.shifts} shifts, {study.simulated_h:,.0f} h"
            f" simulated in {self._line.wall:,.0f} s"
        )

    def end(self) -> None:
        """Ends the line."""
        self._line.end()
