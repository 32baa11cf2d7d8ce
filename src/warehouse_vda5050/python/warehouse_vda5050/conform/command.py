# SPDX-License-Identifier: Apache-2.0
"""The program: arguments, the run with its progress, and the report."""

from __future__ import annotations

import argparse
import math
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from warehouse_vda5050.codec import codec_for, full_version
from warehouse_vda5050.conform import ground
from warehouse_vda5050.conform.broker import Broker, UnreachableError
from warehouse_vda5050.conform.case import Case
from warehouse_vda5050.conform.cases import cases_of
from warehouse_vda5050.conform.master import command as master
from warehouse_vda5050.conform.master.cases import cases_of as master_cases_of
from warehouse_vda5050.conform.probe import Probe
from warehouse_vda5050.conform.proxy import Proxy
from warehouse_vda5050.conform.report import write
from warehouse_vda5050.conform.report.score import NOT_TRIED, Run, exit_code, line_of, lines
from warehouse_vda5050.conform.runner import NoVehicleError, Runner, begin
from warehouse_vda5050.conform.settings import Settings
from warehouse_vda5050.mqtt.settings import BrokerSettings, read_settings
from warehouse_vda5050.topics import Identity, TopicError, Topics, prefix_of

DESCRIPTION = """Plays the master towards a vehicle of any maker, over MQTT, and judges what it
does by the specification VDA 5050. The vehicle drives: at most --edges edges, straight ahead of
where it stands, or along --nodes, there and back. Keep that way free, and a hand on the emergency
stop. With --master it plays vehicles towards a master of any maker, which has to give them orders,
and judges what it sends. It ends with 0 if all that was tried conforms, 1 if something differs, 2
if it could not be tried. Ctrl-C cancels the order under way, and writes the report so far."""


def arguments() -> argparse.ArgumentParser:
    """Returns the parser of the command line."""
    parser = argparse.ArgumentParser(prog="conform", description=DESCRIPTION)
    add = parser.add_argument
    add("--broker", default="localhost:1883", help="HOST:PORT of the MQTT broker")
    who = parser.add_mutually_exclusive_group()
    who.add_argument("--vehicle", metavar="MANUFACTURER/SERIAL", help="which vehicle to try")
    who.add_argument("--master", action="store_true", help="try the master that drives --play")
    master.add_arguments(parser)
    add("--version", default="2.1", help="of VDA 5050: 2.0, 2.1 or 3.0")
    add("--prefix", default="", help="of topics; empty: uagv/v2 or vda5050/v3")
    add("--strict", action="store_true", help="try recommendations as well")
    add("--out", type=Path, metavar="DIR", help="folder of report.html, junit.xml, messages.jsonl")
    add("--only", nargs="+", default=[], metavar="CASE", help="these cases or chapters alone")
    add("--list", action="store_true", help="list the cases, and end")
    _add_ground(parser)
    add("--action", default="", metavar="TYPE[:KEY=VALUE,…]", help=ACTION)
    add("--proxy", type=int, metavar="PORT", help=PROXY)
    add("--tls", default="", help="true, or the file of a certificate authority")
    add("--user", default="", help="name to log in with")
    add("--password-file", default="", help="file with the password")
    return parser


ACTION = (
    "an action for nodes that does no harm; by default waitForTrigger, if the vehicle has trigger"
)
PROXY = (
    "listen on this port for the vehicle, and pass all on to the broker, so that its connection"
    " can be cut; otherwise these cases are not tried"
)


def _add_ground(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--nodes", type=Path, metavar="FILE", help="where it may drive: a LIF, or a list of nodes")
    add("--edges", type=int, default=3, help="how many edges it may drive (3)")
    add("--spacing", type=float, default=1.0, help="length of an edge without --nodes [m] (1.0)")
    add("--heading", type=float, help="direction of the edges [deg]; by default the vehicle's own")
    add("--edge-time", type=float, default=30.0, help="longest drive along one edge [s] (30)")


def main() -> None:
    """Runs the program."""
    parser = arguments()
    options = parser.parse_args()
    try:
        version = full_version(options.version)
        known = (master_cases_of if options.master else cases_of)(version, options.strict)
        cases = _chosen(known, options.only)
        if options.list:
            print("\n".join(f"{c.id:28} {c.section:9} {c.sentence}" for c in cases))
            return
        sys.exit(_try(options, version, cases))
    except (ValueError, OSError) as error:
        parser.error(str(error))  # ends with 2
    except (NoVehicleError, UnreachableError) as error:
        print(f"conform: {error}", file=sys.stderr)
        sys.exit(NOT_TRIED)


def _chosen(cases: list[Case], only: list[str]) -> list[Case]:
    """Returns the cases of these ids and chapters. Raises ValueError."""
    known = {name for case in cases for name in (case.id, case.chapter)}
    missing = [name for name in only if name not in known]
    if missing:
        raise ValueError(f"no case or chapter {', '.join(missing)}; --list has all")
    return [c for c in cases if not only or c.id in only or c.chapter in only]


def _try(options: argparse.Namespace, version: str, cases: list[Case]) -> int:
    """Tries the cases and writes the report. Returns the exit code."""
    if options.master:
        return master.try_master(options, version, cases)
    if not options.vehicle or not options.out:
        raise ValueError("--vehicle, or --master, and --out are missing")
    who = _vehicle(options.vehicle)
    options.out.mkdir(parents=True, exist_ok=True)
    broker = read_settings(options.broker, options.tls, options.user, options.password_file)
    topics = Topics(options.prefix or prefix_of(version))
    settings = _settings(options)
    wire = Broker(broker, _proxy(options, broker))
    run = f"{time.time_ns() // 1_000_000_000:x}"
    probe = Probe(wire, who, codec_for(version), topics, settings, run)
    try:
        return _tried(options, probe, cases)
    finally:
        wire.close()


def _vehicle(text: str) -> Identity:
    manufacturer, _, serial = text.partition("/")
    try:
        return Identity(manufacturer, serial)
    except TopicError as error:
        raise ValueError(f"vehicle is {text!r}: {error}") from None


def _proxy(options: argparse.Namespace, broker: BrokerSettings) -> Proxy | None:
    if options.proxy is None:
        return None
    proxy = Proxy(options.proxy, broker.host, broker.port)
    print(f"conform: the vehicle may connect to port {proxy.port} of this machine", flush=True)
    return proxy


def _settings(options: argparse.Namespace) -> Settings:
    type, _, pairs = options.action.partition(":")
    parameters = [tuple(pair.partition("=")[::2]) for pair in pairs.split(",") if pair]
    heading = None if options.heading is None else math.radians(options.heading)
    if options.edges < 1 or options.spacing <= 0:
        raise ValueError("--edges and --spacing have to be above 0")
    return Settings(
        edge=options.edge_time,
        case=max(120.0, 4 * options.edge_time),
        spacing=options.spacing,
        edges=options.edges,
        heading=heading,
        action=type,
        parameters=tuple(parameters),
        strict=options.strict,
    )


def ground_for(settings: Settings, nodes: Path | None) -> Callable[[dict[str, Any]], ground.Ground]:
    """Returns what makes the ground of a vehicle's first state."""

    def make(state: dict[str, Any]) -> ground.Ground:
        at, here = state["agvPosition"], str(state.get("lastNodeId") or "conform_0")
        x, y = float(at["x"]), float(at["y"])
        if nodes:
            return ground.read(nodes, here, x, y, settings.edges)
        heading = at.get("theta", 0.0) if settings.heading is None else settings.heading
        map_id = str(at.get("mapId", ""))
        return ground.straight(x, y, map_id, here, heading, settings.spacing, settings.edges)

    return make


def _tried(options: argparse.Namespace, probe: Probe, cases: list[Case]) -> int:
    began, start = time.strftime("%Y-%m-%d %H:%M:%S %Z"), probe.now()
    runner = Runner(probe)
    begin(probe, ground_for(probe.settings, options.nodes))
    former = signal.signal(signal.SIGINT, lambda *_: setattr(probe, "interrupted", True))
    for count, result in enumerate(runner.run(cases), 1):
        print(line_of(count, len(cases), result), flush=True)
    signal.signal(signal.SIGINT, former)
    series = (probe.sheet.get("typeSpecification") or {}).get("seriesName", "")
    run = Run(
        options.vehicle,
        probe.codec.version,
        options.broker,
        began,
        probe.now() - start,
        runner.results,
        str(series),
        probe.interrupted,
    )
    write(options.out, run, probe.log)
    print("\n".join(["", *lines(run), f"report: {options.out / 'report.html'}"]), flush=True)
    return exit_code(run)
