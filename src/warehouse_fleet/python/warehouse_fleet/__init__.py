# SPDX-License-Identifier: Apache-2.0
"""Plans for a fleet."""

from warehouse_fleet._core import (
    Fleet,
    Floor,
    FloorError,
    Planner,
    Rules,
    Violation,
    epibt,
    load_planner,
    validate,
)
