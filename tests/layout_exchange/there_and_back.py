#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Layouts exported as LIF are read by others as they are, and are the same floors when they come
back from there: there_and_back.py PYTHON, an interpreter that has vdma-lif and LIFReader."""

import json
import pathlib
import subprocess
import sys
import tempfile

from warehouse_layout import convert as formats
from warehouse_layout.file import drawn_floor, station_lanes
from warehouse_layout.file.request import PRESETS
from warehouse_layout.generate import generator
from warehouse_layout.place.placement import plan_of

READ = pathlib.Path(__file__).with_name("read_lif.py")
AREAS = ("exits", "passable", "storage", "parking")


def plan(file):
    drawn = drawn_floor.areas(file.floor)
    return plan_of(file, drawn, station_lanes.of_file(file, drawn)[0])


def lanes(file):
    return {(s.name, s.kind, s.queue, s.service, s.exit) for s in file.stations}


def expected(path):
    """Returns what the file says, as read_lif.py has it."""
    (layout,) = json.loads(path.read_text())["layouts"]
    return {
        "nodes": sorted([n["nodeId"], *n["nodePosition"].values()] for n in layout["nodes"]),
        "edges": sorted([e["startNodeId"], e["endNodeId"]] for e in layout["edges"]),
        "stations": sorted([s["stationId"], *s["interactionNodeIds"]] for s in layout["stations"]),
    }


def check(python, preset, folder):
    file = generator.of_request(PRESETS[preset], preset)
    ours, theirs = folder / f"{preset}.lif.json", folder / f"{preset}.theirs.lif.json"
    formats.write(file, ours)
    command = [python, READ, ours, theirs]
    answers = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    for reader, answer in answers.items():
        assert answer == expected(ours), f"{preset}: {reader} read something else"
    back, left_out = formats.read(theirs)
    assert left_out == [], left_out
    before, after = plan(file), plan(back)
    width = after.shape[1]  # the belts beyond are lost
    for name in AREAS:
        same = getattr(before, name)[:, :width] == getattr(after, name)
        assert same.all(), f"{preset}: {name} differ"
    assert after.point_of(0) == before.point_of(0) and lanes(back) == lanes(file), preset
    sizes = ", ".join(f"{len(part)} {name}" for name, part in answers["vdma-lif"].items())
    print(
        f"{preset}: {sizes}, read by {' and '.join(answers)}; the same floor comes back", flush=True
    )


def main():
    with tempfile.TemporaryDirectory() as folder:
        for preset in ("small", "medium", "large"):
            check(sys.argv[1], preset, pathlib.Path(folder))


if __name__ == "__main__":
    main()
