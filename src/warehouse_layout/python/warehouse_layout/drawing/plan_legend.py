# SPDX-License-Identifier: Apache-2.0
"""The legend of a drawn plan: a symbol for each kind of thing on it, drawn at a point [in]."""

from collections.abc import Callable
from typing import Any

import numpy as np

from warehouse_layout.drawing.plan_layers import Subject, add
from warehouse_layout.file import layout_file as lf
from warehouse_layout.floor import outlines as shapes
from warehouse_layout.floor.palette import PLAN
from warehouse_layout.floor.stations import PICK, lane_mask

SIZE = 0.095  # [in]: half of a symbol

Symbol = Callable[[Any, np.ndarray], None]


def _of(*parts: tuple[np.ndarray, float, str]) -> Symbol:
    """Returns a symbol of outlines, each with its size and colour."""

    def draw(axes: Any, at: np.ndarray) -> None:
        for outline, size, colour in parts:
            style = {"edgecolor": PLAN["stripe"], "linewidth": 0.3 if size == 1 else 0}
            outlines = shapes.placed(outline, at, SIZE * size)
            add(axes, outlines, facecolor=PLAN[colour], **style)

    return draw


_SQUARE, _ON = shapes.SQUARE, (shapes.SQUARE, 1, "floor")
_STRIPE = np.array([(-1, -1), (-0.72, -1), (1, 0.72), (1, 1)])

SYMBOLS: dict[str, tuple[Symbol, str]] = {
    "robot": (_of((shapes.DISC, 0.9, "robot"), (shapes.TIP, 0.75, "paper")), "robot"),
    "unit": (
        _of((_SQUARE, 0.8, "unit"), (_SQUARE, 0.6, "storage"), (_SQUARE, 0.44, "unit")),
        "storage unit",
    ),
    "storage": (_of((_SQUARE, 1, "storage")), "storage place"),
    "parking": (_of((_SQUARE, 1, "parking")), "parking"),
    "charging": (_of((_SQUARE, 1, "charging"), (shapes.BOLT, 0.75, "bolt")), "charging place"),
    "street": (_of(_ON), "street, driven any way"),
    "one_way": (_of(_ON, (shapes.ARROW, 0.8, "arrow")), "one-way street"),
    "both_ways": (_of(_ON, (shapes.BOTH_WAYS, 0.8, "arrow")), "both ways along one axis"),
    "pick": (_of((_SQUARE, 1, "service")), "picking station: service"),
    "replenish": (_of((_SQUARE, 1, "replenish")), "replenishment: service"),
    "queue": (_of((_SQUARE, 1, "queue"), (shapes.DISC, 0.3, "lane")), "queue, from its entry"),
    "exit": (_of((_SQUARE, 1, "exit"), (shapes.ARROW, 0.7, "lane")), "way out of a station"),
    "elevator": (_of((_SQUARE, 1, "elevator"), (shapes.UP_DOWN, 0.8, "paper")), "elevator"),
    "belt": (_of((_SQUARE, 1, "belt")), "conveyor belt"),
    "wall": (_of((_SQUARE, 1, "wall")), "wall, pillar"),
    "keep_out": (_of((_SQUARE, 1, "keep_out"), (_STRIPE, 0.99, "stripe")), "no robot drives"),
    "fault": (_of((_SQUARE, 1, "fault")), "station without a lane"),
}


def counted(subject: Subject) -> dict[str, Any]:
    """Returns how often each kind is on the plan; True where the number means nothing."""
    floor, drawn, layout = subject.file.floor, subject.drawn, subject.layout
    lane = lane_mask(subject.stations, floor.shape)
    picks = sum(station.kind == PICK for station in subject.stations)
    street = floor[drawn.streets & ~lane]
    return {
        "robot": len(layout.robots) if layout else 0,
        "unit": len(layout.units) if layout else 0,
        "storage": int(drawn.storage.sum()),
        "parking": int((drawn.parking & ~drawn.charging).sum()),
        "charging": int(drawn.charging.sum()),
        "street": bool((street == lf.FLOOR).any()),
        "one_way": bool(np.isin(street, list(lf.ONE_WAY)).any()),
        "both_ways": bool(np.isin(street, [lf.ALONG_X, lf.ALONG_Y]).any()),
        "pick": picks,
        "replenish": len(subject.stations) - picks,
        "queue": bool(lane.any()),
        "exit": bool(lane.any()),
        "elevator": len(subject.file.elevators),
        "belt": bool(drawn.belts.any()),
        "wall": bool(drawn.walls.any()),
        "keep_out": bool((floor == lf.KEEP_OUT).any()),
        "fault": len(subject.file.stations) - len(subject.stations),
    }
