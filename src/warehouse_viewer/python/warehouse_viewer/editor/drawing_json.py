# SPDX-License-Identifier: Apache-2.0
"""A layout file as the page takes it."""

from typing import Any

from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import ElevatorEntry, LayoutFile, StationEntry


def of_file(file: LayoutFile) -> dict[str, Any]:
    """Returns what a layout file says, in JSON: the highest line first, cells as [column, row]."""
    return {
        "name": file.name,
        "spacing": file.spacing,
        "floor": layout_file.lines_of(file.floor),
        "stations": [_station(station) for station in file.stations],
        "elevators": [_elevator(elevator) for elevator in file.elevators],
        "storage_units": _places(file.storage_units),
        "is_share": isinstance(file.storage_units, float),  # in JSON 1.0 would be a count
        "robots": _places(file.robots),
        "items": file.items,
        "stock": file.stock,
        "skus": file.skus,
        "policies": dict(file.policies),
        "measured": file.measured,
        "building": file.building,
        "at": file.at,
    }


def _station(station: StationEntry) -> dict[str, Any]:
    return {
        "key": station.key,
        "service": station.service,
        "name": station.name,
        "kind": station.kind,
        "queue": station.queue,
        "exit": station.exit,
        "short_cuts": station.short_cuts,
        "settings": dict(station.settings),
    }


def _elevator(elevator: ElevatorEntry) -> dict[str, Any]:
    return {"name": elevator.name, "cells": elevator.cells, "seconds": elevator.seconds}


def _places(value: object) -> object:
    return [list(cell) for cell in value] if isinstance(value, tuple) else value
