# SPDX-License-Identifier: Apache-2.0
"""The program replay: sends what record has written to a broker again."""

import argparse
import math
import signal
import sys
import time
from pathlib import Path

from warehouse_layout.cli.progress_line import ProgressLine
from warehouse_vda5050.mqtt.loop import Link, MqttLoop
from warehouse_vda5050.mqtt.options import add_options, settings_of
from warehouse_vda5050.recording import file
from warehouse_vda5050.recording.file import RecordingError
from warehouse_vda5050.recording.player import Extent, Player

DESCRIPTION = """Sends the messages of a recording to a broker, in their order and with the time
between them. The broker keeps connections and factsheets, as when they were sent first. The whole
file is read before the first message goes out. Ctrl-C ends it."""
PERIOD = 1.0  # between two looks at the progress [s]
PATIENCE = 10.0  # for the first connection [s]


def arguments() -> argparse.ArgumentParser:
    """Returns the parser of the command line."""
    parser = argparse.ArgumentParser(prog="replay", description=DESCRIPTION)
    parser.add_argument("file", type=Path, metavar="F.jsonl.zst", help="what record has written")
    add_options(parser)
    parser.add_argument("--speed", type=float, default=1.0, help="times real time (1)")
    return parser


def main() -> None:
    """Runs the program."""
    parser = arguments()
    options = parser.parse_args()
    try:
        if not (math.isfinite(options.speed) and options.speed > 0):
            raise ValueError(f"speed is {options.speed:g}; a number above 0 was expected")
        extent = Extent.of(file.read(options.file))
        if not extent.count:
            raise RecordingError(f"{options.file}:1: a message was expected")
        sys.exit(_replay(options, extent))
    except (ValueError, OSError) as error:
        parser.error(str(error))


def _replay(options: argparse.Namespace, extent: Extent) -> int:
    """Sends all; returns the exit code."""
    loop = MqttLoop()
    link = loop.add(Link(f"replay-{time.time_ns()}", settings_of(options), [], lambda *_: None))
    player = Player(loop, link, options.speed)
    progress = _Progress(player, extent)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: setattr(player, "stopped", True))
    try:
        _connect(loop, link, player)
        seconds = extent.seconds / options.speed
        print(f"replay: {extent.count} messages in {seconds:.1f} s; Ctrl-C ends it", flush=True)
        player.play(file.read(options.file), progress.show)
    finally:
        progress.clear()
        link.close()
        loop.close()
    whole = player.sent == extent.count
    print(f"replay: {player.sent} of {extent.count} messages are sent", flush=True)
    return 0 if whole else 1


def _connect(loop: MqttLoop, link: Link, player: Player) -> None:
    end = time.monotonic() + PATIENCE
    while not (link.connected or player.stopped):
        loop.poll(0.05)
        if time.monotonic() > end:
            raise OSError(f"{link.broker.host}:{link.broker.port}: {link.fault}")


class _Progress:
    """Tells how far a replay is."""

    def __init__(self, player: Player, extent: Extent) -> None:
        self._player, self._extent = player, extent
        self._line = ProgressLine(sys.stdout, period=PERIOD)

    def show(self) -> None:
        """Shows it, if it is time to."""
        if not self._line.is_due():
            return
        player, extent = self._player, self._extent
        at = max(0.0, player.time - extent.begin) if player.sent else 0.0
        text = f"{at:.1f} of {extent.seconds:.1f} s, {player.sent} of {extent.count} messages"
        self._line.show(player.sent / extent.count, f"replay: {text}")

    def clear(self) -> None:
        """Takes the line away: what comes next has the result."""
        self._line.clear()
