# SPDX-License-Identifier: Apache-2.0
"""The program record: writes down every message of a broker's prefix."""

import argparse
import signal
import sys
import time
from pathlib import Path

from warehouse_vda5050.conform.broker import Broker, UnreachableError
from warehouse_vda5050.mqtt.options import add_options, settings_of
from warehouse_vda5050.recording.file import Writer
from warehouse_vda5050.recording.recorder import Recorder
from warehouse_vda5050.topics import PREFIXES, Topics

DESCRIPTION = """Writes every message below a prefix of a broker into a file: when it arrived, its
topic and payload, and whether it fits the official schema of its version or why not. Ctrl-C ends
it, with a summary. The file is JSON, a line a message, compressed: zstdcat shows it."""
PERIOD = 10.0  # between two lines about the progress [s]
REST = (
    0.3,
    3.0,
)  # silence that ends the reading of what is on its way, and how long that may take [s]


def arguments() -> argparse.ArgumentParser:
    """Returns the parser of the command line."""
    parser = argparse.ArgumentParser(prog="record", description=DESCRIPTION)
    add_options(parser)
    add = parser.add_argument
    add("--prefix", default=PREFIXES[2], help="of topics (uagv/v2)")
    add("--out", type=Path, required=True, metavar="F.jsonl.zst", help="a new file")
    add("--seconds", type=float, default=0.0, help="end after this many seconds; 0: at Ctrl-C")
    return parser


def main() -> None:
    """Runs the program."""
    parser = arguments()
    options = parser.parse_args()
    try:
        if not 0 <= options.seconds < float("inf"):
            raise ValueError(f"seconds is {options.seconds:g}; 0 or more was expected")
        sys.exit(_record(options))
    except FileExistsError:
        parser.error(f"{options.out} is there already; a new file was expected")
    except (ValueError, OSError, UnreachableError) as error:
        parser.error(str(error))


def _record(options: argparse.Namespace) -> int:
    """Records until a signal comes; returns the exit code."""
    topics, stopped = Topics(options.prefix), []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stopped.append(True))
    broker = Broker(settings_of(options), name="record")
    try:
        recorder = Recorder(Writer(options.out), topics)
        broker.take = lambda m: recorder.take(m.topic, m.payload, m.qos, m.retained)
        broker.subscribe(f"{options.prefix}/#")
        print(f"record: {options.prefix}/# of {options.broker}; Ctrl-C ends it", flush=True)
        _serve(broker, recorder, stopped, options.seconds)
    finally:
        broker.close()
    return _end(recorder, options.out)


def _serve(broker: Broker, recorder: Recorder, stopped: list[bool], seconds: float) -> None:
    begin = time.monotonic()
    shown, end = begin, begin + (seconds or float("inf"))
    while not stopped and not recorder.fault and time.monotonic() < end:
        broker.poll(0.05)
        if time.monotonic() - shown >= PERIOD:
            shown = time.monotonic()
            print(f"record: {recorder.total} messages, {recorder.invalid} not valid", flush=True)
    _take_rest(broker, recorder)


def _take_rest(broker: Broker, recorder: Recorder) -> None:
    """Takes what the broker had sent before the end."""
    begin = quiet = time.monotonic()
    count = recorder.taken
    while time.monotonic() - quiet < REST[0] and time.monotonic() - begin < REST[1]:
        broker.poll(0.05)
        if recorder.taken != count:
            count, quiet = recorder.taken, time.monotonic()


def _end(recorder: Recorder, out: Path) -> int:
    """Closes the file and prints the summary; returns the exit code."""
    try:
        size = recorder.close()
    except OSError as error:
        print("\n".join(["", *recorder.summary()]), flush=True)
        print(f"record: {out} ends here: {error}", file=sys.stderr)
        return 1
    print("\n".join(["", *recorder.summary(), f"{out}: {size} bytes"]), flush=True)
    return 0
