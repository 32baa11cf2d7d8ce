# SPDX-License-Identifier: Apache-2.0
"""Places where no vehicle can be (6.1.1, 6.1.4). Tried late: one that takes them is lost."""

from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.probe import Probe

chapter = Chapter("places")
case = chapter.case


@case("map", "6.1.1", edges=1)
def other_map(probe: Probe) -> None:
    """A node on a map that the vehicle does not have is refused."""
    order = probe.new_order(probe.way(1))
    order["nodes"][1]["nodePosition"]["mapId"] = "conform_no_such_map"
    probe.refuses(order)
    probe.never(lambda s: s.get("driving"), "it drives", 1.0)


@case("infinite", "6.1.4", edges=1)
def infinite(probe: Probe) -> None:
    """A position of NaN is refused: JSON has no such number."""
    order = probe.new_order(probe.way(1))
    order["nodes"][1]["nodePosition"]["x"] = float("nan")
    probe.refuses(order, "validationError", "orderError")
    probe.finished(probe.instant("stateRequest"))
