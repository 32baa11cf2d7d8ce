# SPDX-License-Identifier: Apache-2.0
"""The program with --master: vehicles to play, the run with its progress, and the report."""

from __future__ import annotations

import argparse
import math
import signal
import time
from pathlib import Path

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.conform.case import Case
from warehouse_vda5050.conform.master.actor import Role
from warehouse_vda5050.conform.master.broker_wire import BrokerWire
from warehouse_vda5050.conform.master.runner import Runner
from warehouse_vda5050.conform.master.settings import Settings
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.report import write
from warehouse_vda5050.conform.report.score import Run, exit_code, line_of, lines
from warehouse_vda5050.model import MAP_ID
from warehouse_vda5050.mqtt.settings import read_settings
from warehouse_vda5050.topics import Identity, TopicError, Topics, prefix_of

PLAY = (
    "a vehicle to play, and where it stands [m, deg], with the id of that node (conform/1@0,0,0);"
    " several may be given"
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds the arguments that belong to --master."""
    add = parser.add_argument
    roles = "MANUFACTURER/SERIAL[@X,Y[,THETA[,NODE]]]"
    add("--play", nargs="+", default=["conform/1"], metavar=roles, help=PLAY)
    add("--map", default=MAP_ID, help=f"mapId that these vehicles report ({MAP_ID})")
    add("--patience", type=float, default=60.0, help="wait for an order of the master [s] (60)")


def roles_of(texts: list[str]) -> list[Role]:
    """Returns the vehicles to play. Raises ValueError."""
    roles = [_role(text) for text in texts]
    names = [role.identity for role in roles]
    if len(set(names)) < len(names):
        raise ValueError("--play names a vehicle twice")
    return roles


def _role(text: str) -> Role:
    name, _, place = text.partition("@")
    manufacturer, _, serial = name.partition("/")
    try:
        identity = Identity(manufacturer, serial)
        numbers = place.split(",")[:3] if place else []
        values = [float(number) for number in numbers]
        if len(values) == 1 or not all(map(math.isfinite, values)):
            raise ValueError("a place is X,Y or X,Y,THETA or X,Y,THETA,NODE")
    except (TopicError, ValueError) as error:
        raise ValueError(f"--play has {text!r}: {error}") from None
    x, y, degrees = (*values, 0.0, 0.0, 0.0)[:3] if values else (0.0, 0.0, 0.0)
    node = ",".join(place.split(",")[3:]) or "conform_start"
    return Role(identity, x, y, math.radians(degrees), node)


def try_master(options: argparse.Namespace, version: str, cases: list[Case]) -> int:
    """Tries the cases on the master at a broker, and writes the report. Returns the exit code.
    Raises UnreachableError, ValueError."""
    if not options.out:
        raise ValueError("--out is missing")
    if options.patience <= 0:
        raise ValueError("--patience has to be above 0")
    roles = roles_of(options.play)
    options.out.mkdir(parents=True, exist_ok=True)
    broker = read_settings(options.broker, options.tls, options.user, options.password_file)
    topics = Topics(options.prefix or prefix_of(version))
    settings = Settings(patience=options.patience, strict=options.strict)
    stage = Stage(
        BrokerWire(broker),
        roles,
        codec_for(version),
        topics,
        settings,
        options.map,
        broker,
        lambda text: print(f"conform: {text}", flush=True),
    )
    try:
        return _tried(options.broker, options.out, stage, cases)
    finally:
        stage.close()


def _tried(broker: str, folder: Path, stage: Stage, cases: list[Case]) -> int:
    began = time.strftime("%Y-%m-%d %H:%M:%S %Z")
    runner = Runner(stage)
    former = signal.signal(signal.SIGINT, lambda *_: setattr(stage, "interrupted", True))
    for count, result in enumerate(runner.run(cases), 1):
        print(line_of(count, len(cases), result), flush=True)
    signal.signal(signal.SIGINT, former)
    vehicles = ", ".join(actor.name for actor in stage.actors)
    run = Run(
        f"the master of {vehicles}",
        stage.codec.version,
        broker,
        began,
        stage.now(),
        runner.results,
        interrupted=stage.interrupted,
    )
    write(folder, run, stage.log)
    print("\n".join(["", *lines(run), f"report: {folder / 'report.html'}"]), flush=True)
    return exit_code(run)
