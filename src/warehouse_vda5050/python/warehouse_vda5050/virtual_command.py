# SPDX-License-Identifier: Apache-2.0
"""The program virtual: many vehicles at a broker, for load tests of masters."""

import argparse
import math
import re
import signal
import sys
import time
from pathlib import Path

from warehouse_vda5050.codec import DEFAULT_VERSION, codec_for
from warehouse_vda5050.faults import script
from warehouse_vda5050.faults.kinds import FaultError
from warehouse_vda5050.faults.script import FaultScript
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.mqtt.options import add_options, settings_of
from warehouse_vda5050.topics import Kind, Topics, prefix_of
from warehouse_vda5050.virtual import VirtualFleet, VirtualSettings

DESCRIPTION = """Puts many vehicles at a broker that drive by a formula: no world, no physics, no
contact. Their nodes are c<column>_<row>, the middle of each cell; each lifts a unit wherever it is
asked to. Every ten seconds it prints how many states a second they send, and what share of a core
that costs. Ctrl-C ends it."""
PERIOD = 0.05  # between two updates [s]
SHOWN = 10.0  # between two lines of figures [s]
PATIENCE = 10.0  # for the first connection [s]
MOST_FLOOR = 1000  # columns or rows


def arguments() -> argparse.ArgumentParser:
    """Returns the parser of the command line."""
    parser = argparse.ArgumentParser(prog="virtual", description=DESCRIPTION)
    add_options(parser)
    add = parser.add_argument
    add("--vehicles", type=int, default=100, help="how many (100); serials are 1, 2, …")
    add("--floor", default="40x25", metavar="WxH", help="columns and rows of cells (40x25)")
    add("--spacing", type=float, default=1.0, help="edge of a cell [m] (1.0)")
    add("--speed", type=float, default=1.5, help="of driving vehicles [m/s] (1.5)")
    add("--manufacturer", default="kiva", help="in topics and headers (kiva)")
    add("--version", default=DEFAULT_VERSION, help="of VDA 5050: 2.0.0, 2.1.0 or 3.0.0")
    add("--prefix", default="", help="of topics; empty: uagv/v2 or vda5050/v3")
    add("--interval", type=float, default=1.0, help="between two states of one that drives [s]")
    add("--visualization", type=float, default=1.0, help="between two positions [s]; 0: none")
    add(
        "--faults",
        type=Path,
        metavar="F.yaml",
        help="faults with times: at, vehicle, fault, seconds",
    )
    return parser


def main() -> None:
    """Runs the program."""
    parser = arguments()
    options = parser.parse_args()
    try:
        faults = script.read(options.faults) if options.faults else None
        fleet = VirtualFleet(_settings(options))
        _run(fleet, faults, options)
    except (ValueError, OSError) as error:
        parser.error(str(error))


def _settings(options: argparse.Namespace) -> VirtualSettings:
    _check(options)
    codec = codec_for(options.version)
    return VirtualSettings(
        options.vehicles,
        options.manufacturer,
        codec,
        Topics(options.prefix or prefix_of(codec.version)),
        settings_of(options),
        _grid(options),
        options.speed,
        options.interval,
        options.visualization,
    )


def _check(options: argparse.Namespace) -> None:
    """Raises ValueError for numbers that can't be."""
    for name, least in (("spacing", 0.01), ("speed", 0.01), ("interval", 0.01)):
        value = getattr(options, name)
        if not (math.isfinite(value) and value >= least):
            raise ValueError(f"{name} is {value:g}; {least:g} or more was expected")
    if not (math.isfinite(options.visualization) and options.visualization >= 0):
        raise ValueError(f"visualization is {options.visualization:g}; 0 or more was expected")


def _grid(options: argparse.Namespace) -> Grid:
    match = re.fullmatch(r"(\d{1,4})x(\d{1,4})", options.floor)
    columns, rows = (int(match[1]), int(match[2])) if match else (0, 0)
    if not (1 <= columns <= MOST_FLOOR and 1 <= rows <= MOST_FLOOR):
        raise ValueError(f"floor is {options.floor!r}; 40x25, say, was expected: columns x rows")
    return Grid(0.0, 0.0, options.spacing, columns, rows)


def _run(fleet: VirtualFleet, faults: FaultScript | None, options: argparse.Namespace) -> None:
    stopped: list[bool] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stopped.append(True))
    begin = time.monotonic()
    figures = _Figures(fleet)
    try:
        while not stopped:
            fleet.loop.poll(PERIOD)
            now = time.monotonic()
            for fault in faults.due(now - begin) if faults else ():
                _begin_fault(fleet, fault, now)
            fleet.tick(now)
            figures.show(now)
            if not figures.was_connected and now - begin > PATIENCE:
                raise OSError(f"{options.broker}: {fleet.links[0].link.fault}")
    finally:
        fleet.close()


def _begin_fault(fleet: VirtualFleet, fault: script.ScriptedFault, now: float) -> None:
    try:
        fleet.begin_fault(fault.vehicle, fault.request, now)
    except FaultError as error:
        print(f"virtual: {fault.where}: {error}", file=sys.stderr)


class _Figures:
    """Prints what the vehicles do, and what they cost."""

    def __init__(self, fleet: VirtualFleet) -> None:
        self._fleet, self.was_connected = fleet, False
        self._shown, self._cpu, self._sent = time.monotonic(), time.process_time(), 0

    def show(self, now: float) -> None:
        """Prints a line each SHOWN seconds, and one once all are connected."""
        fleet = self._fleet
        if not self.was_connected and fleet.connected == len(fleet.links):
            self.was_connected = True
            print(f"virtual: {fleet.connected} vehicles are connected; Ctrl-C ends it", flush=True)
        if now - self._shown < SHOWN:
            return
        sent, cpu, span = fleet.sent[Kind.STATE], time.process_time(), now - self._shown
        print(
            f"virtual: {fleet.connected} connected, {fleet.moving} driving,"
            f" {(sent - self._sent) / span:.0f} states/s, {(cpu - self._cpu) / span:.2f} cores",
            flush=True,
        )
        self._shown, self._cpu, self._sent = now, cpu, sent
