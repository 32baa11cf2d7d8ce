# SPDX-License-Identifier: Apache-2.0
"""Writes layouts in VDMA's Layout Interchange Format 1.0, `.lif.json`.

Each cell on which robots drive is a node, and each way from one to the next an edge. A node on
which units are lifted and set down has the actions `pick` and `drop`.
"""

import json
from collections.abc import Iterator
from datetime import UTC, datetime
from typing import Any

import numpy as np

from warehouse_layout.convert.common import PathName, cells_of, named, write_text
from warehouse_layout.file import drawn_floor, station_lanes
from warehouse_layout.file.layout_file import Cell, LayoutFile
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.stations import STEPS
from warehouse_layout.place.placement import origin, plan_of

VERSION = "1.0.0"
ROBOT = "kiva"  # vehicleTypeId
MAP = "floor"
WORDS = {"storage": "storage place", "parking": "parking", "charging": "charging place"}


def write(file: LayoutFile, path: PathName) -> list[str]:
    """Writes a layout; returns what LIF can't hold. Raises FormatError."""
    drawn = drawn_floor.areas(file.floor)
    stations, faults = station_lanes.of_file(file, drawn)
    plan = plan_of(file, drawn, stations)
    head = {
        "metaInformation": {
            "projectIdentification": file.title,
            "creator": "warehouse_layout",
            "exportTimestamp": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
            "lifVersion": VERSION,
        }
    }
    about = {"layoutId": file.title, "layoutName": file.title, "layoutVersion": "1"}
    # A line for each node and edge: large files stay readable, and are written quickly.
    text = json.dumps(head, ensure_ascii=False)[:-1] + ', "layouts": [' + json.dumps(about)[:-1]
    for name, part in (
        ("nodes", _nodes(plan, drawn.charging)),
        ("edges", _edges(plan)),
        ("stations", _stations(file)),
    ):
        lines = ",\n".join(json.dumps(entry, ensure_ascii=False) for entry in part)
        text += f',\n"{name}": [\n{lines}\n]'
    write_text(path, text + "}]}\n")
    return [fault.text for fault in faults] + _lost(file)


def _name(cell: Cell) -> str:
    return f"{cell[0]}_{cell[1]}"


def _nodes(plan: FloorPlan, charging: np.ndarray) -> Iterator[dict[str, Any]]:
    for column, row in cells_of(plan.passable):
        x, y = plan.point_of(row * plan.width + column)
        kind = next(
            (
                kind
                for kind, mask in (
                    ("storage", plan.storage),
                    ("charging", charging),
                    ("parking", plan.parking),
                )
                if mask[row, column]
            ),
            "",
        )
        yield {
            "nodeId": _name((column, row)),
            **({"nodeDescription": WORDS[kind]} if kind else {}),
            "mapId": MAP,
            "nodePosition": {"x": round(x, 4), "y": round(y, 4)},
            "vehicleTypeNodeProperties": [
                {"vehicleTypeId": ROBOT, **({"actions": _actions(kind)} if _actions(kind) else {})}
            ],
        }


def _actions(kind: str) -> list[dict[str, str]]:
    names = {"storage": ("pick", "drop"), "charging": ("startCharging", "stopCharging")}
    return [
        {"actionType": name, "requirementType": "CONDITIONAL", "blockingType": "HARD"}
        for name in names.get(kind, ())
    ]


def _edges(plan: FloorPlan) -> Iterator[dict[str, Any]]:
    """Yields all edges; those beneath units, and to parking, are for robots without a load."""
    narrow = plan.storage | plan.parking
    for column, row in cells_of(plan.passable):
        for heading, (dx, dy) in enumerate(STEPS):
            if not plan.exits[row, column] >> heading & 1:
                continue
            there = column + dx, row + dy
            both = narrow[row, column] and narrow[there[::-1]]
            loaded = not both and not plan.parking[there[::-1]] and not plan.parking[row, column]
            here = column, row
            yield {
                "edgeId": f"{_name(here)}-{_name(there)}",
                "startNodeId": _name(here),
                "endNodeId": _name(there),
                "vehicleTypeEdgeProperties": [
                    {
                        "vehicleTypeId": ROBOT,
                        "orientationType": "TANGENTIAL",
                        "vehicleOrientation": 0.0,
                        "rotationAllowed": False,
                        "loadRestriction": {"unloaded": True, "loaded": bool(loaded)},
                    }
                ],
            }


def _stations(file: LayoutFile) -> Iterator[dict[str, Any]]:
    x0, y0 = origin(file)
    for station in file.stations:
        column, row = station.service
        yield {
            "stationId": station.key,
            "interactionNodeIds": [_name(station.service)],
            "stationName": station.name,
            "stationDescription": "replenishment"
            if station.kind == "replenish"
            else "picking station",
            "stationPosition": {
                "x": round(x0 + column * file.spacing, 4),
                "y": round(y0 + row * file.spacing, 4),
            },
        }


def _lost(file: LayoutFile) -> list[str]:
    out = [
        f"LIF has no {what}: {named(cells)}"
        for what, character in (("walls", "#"), ("conveyor belts", "="), ("keep-out areas", "x"))
        if (cells := cells_of(file.floor == character))
    ]
    out += [f"station {s.name}: its times are lost" for s in file.stations if s.settings]
    held = {
        "robots": file.robots,
        "storage units": file.storage_units,
        "items": file.items or file.stock,
        "policies": file.policies,
        "measured": file.measured,
        "building": file.building,
    }
    names = [name for name, there in held.items() if there]
    return [*out, f"LIF holds none of: {', '.join(names)}"] if names else out
