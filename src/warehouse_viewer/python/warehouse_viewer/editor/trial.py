# SPDX-License-Identifier: Apache-2.0
"""Lets ideal robots work in a drawing: `python3 -m warehouse_viewer.editor.trial < F.layout.yaml`.

A process of its own, so that it can be ended at once and takes no time from a viewer. Prints JSON,
a line each: {time, of, pieces, waiting: {station: units}} now and then, and as the last {result} or
{error}.
"""

import signal
import sys
import time as clock
from collections.abc import Iterator
from typing import Any

from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import LayoutFile, LayoutFileError
from warehouse_layout.place.file_check import faults
from warehouse_layout.place.placement import place
from warehouse_operations import Operations, PolicyError, Site
from warehouse_operations.fleets.ideal import IdealFleet
from warehouse_operations.runs import layout_site
from warehouse_viewer.json_text import dumps

SECONDS = 600.0  # that robots work, simulated
SLICE = 5.0  # between two reports of progress [s, simulated]
PERIOD = 0.1  # between two lines, wall [s]


class TrialError(ValueError):
    """Says why no robot can work there."""


def lines(text: str) -> Iterator[dict[str, Any]]:
    """Yields what happens in the warehouse of a layout file's text. Raises LayoutFileError,
    TrialError, PolicyError."""
    file = layout_file.parse(text)
    site = layout_site.of_file(Site.of_layout(place(file), file.title), file)
    _check(file, site)
    policies = layout_site.policies_of(file)
    with Operations(site=site, orders="fill", policies=policies, physics=False) as ops:
        last = 0.0
        while ops.time < SECONDS:
            ops.run(seconds=min(SLICE, SECONDS - ops.time))
            if clock.monotonic() - last > PERIOD:
                last = clock.monotonic()
                yield _progress(ops)
        yield {"result": _result(ops)}


def _check(file: LayoutFile, site: Site) -> None:
    lacks = {
        "a robot": not site.robots,
        "a storage unit": not site.units,
        "an item in stock": not site.items,
        "a picking station": not any(s.kind == "PICK" for s in site.plan.stations),
    }
    missing = [what for what, lacks_it in lacks.items() if lacks_it]
    if missing:
        raise TrialError(f"robots can't work there: the drawing lacks {', '.join(missing)}")
    wrong = faults(file)
    if wrong:
        raise TrialError(f"robots can't work there yet: {wrong[0].text}")


def _ideal(ops: Operations) -> IdealFleet:
    assert isinstance(ops.fleet, IdealFleet)
    return ops.fleet


def _progress(ops: Operations) -> dict[str, Any]:
    stations = ops.site.plan.stations
    return {
        "time": ops.time,
        "of": SECONDS,
        "pieces": ops.shift.tally.items_picked,
        "waiting": {s.name: _ideal(ops).waiting(s.name) for s in stations},
    }


def _result(ops: Operations) -> dict[str, Any]:
    kpis, tally = ops.kpis(), ops.shift.tally
    waited = _ideal(ops).waiting_map()
    return {
        "seconds": ops.time,
        "pieces": tally.items_picked,
        "pieces_per_hour": kpis["item_throughput_per_hour"],
        "most_pieces_per_hour": kpis["item_upper_bound_per_hour"],
        "orders": tally.orders_completed,
        "per_minute": [tally.picked_in.get(i, 0) for i in range(int(SECONDS // 60))],
        "stations": [
            {
                "name": station.name,
                "kind": station.kind,
                "cell": [
                    station.service_cell % waited.shape[1],
                    station.service_cell // waited.shape[1],
                ],
                "queue": float(waited.flat[station.queue].sum()) / ops.time,
                "busy": ops.shift.station(station.name).busy_fraction(ops.time),
            }
            for station in ops.site.plan.stations
        ],
        "traffic": _ideal(ops).passages().ravel().astype(int).tolist(),
        "waiting": waited.ravel().round(1).tolist(),
        "width": int(waited.shape[1]),
    }


def main() -> None:
    """Reads the text from stdin and prints lines."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        for line in lines(sys.stdin.read()):
            print(dumps(line), flush=True)
    except (LayoutFileError, TrialError, PolicyError) as error:
        print(dumps({"error": str(error).removeprefix("layout:").strip()}), flush=True)


if __name__ == "__main__":
    main()
