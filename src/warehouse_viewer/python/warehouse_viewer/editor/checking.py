# SPDX-License-Identifier: Apache-2.0
"""What is wrong with a drawing, and the lanes that its stations get where none is drawn."""

from typing import Any

from warehouse_layout.file import drawn_floor, layout_file, station_lanes
from warehouse_layout.file.layout_file import Cell, LayoutFile, LayoutFileError
from warehouse_layout.place.file_check import faults, remarks

NAME = "layout"  # of the text, in errors


def checked(text: str) -> dict[str, Any]:
    """Returns {faults: [{text, cells}], remarks: [text], lanes: {station's key: [cells]}} of a
    file's text."""
    try:
        file = layout_file.parse(text, NAME)
    except LayoutFileError as error:
        return {"faults": [{"text": text_of(error), "cells": []}], "remarks": [], "lanes": {}}
    rows = [{"text": fault.text, "cells": fault.cells} for fault in faults(file)]
    return {
        "faults": rows,
        "remarks": [] if rows else remarks(file),
        "lanes": _lanes_found(file),
    }


def text_of(error: LayoutFileError) -> str:
    """Returns what an error says, without the name of a text that has none."""
    return str(error).removeprefix(f"{NAME}:").strip()


def _lanes_found(file: LayoutFile) -> dict[str, list[Cell]]:
    """Returns the lanes of stations whose queue or exit is not drawn, in driving order."""
    open_ended = {s.name: s.key for s in file.stations if not (s.queue and s.exit)}
    if not open_ended:
        return {}
    stations, _ = station_lanes.of_file(file, drawn_floor.areas(file.floor))
    width = file.shape[1]
    return {
        open_ended[s.name]: [(int(c) % width, int(c) // width) for c in s.cells]
        for s in stations
        if s.name in open_ended
    }
