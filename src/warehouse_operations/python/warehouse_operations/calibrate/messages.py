# SPDX-License-Identifier: Apache-2.0
"""The recording that a log of VDA 5050 messages is: a JSON object a line, with time, topic and
payload, as `warehouse_vda5050 record` and `conform` write it; plain, or compressed by zstd.

States and visualizations of 2.x and 3.0 have the position and the speed of a vehicle, its load, its
battery, its actions and its errors.
"""

import io
import json
import math
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any

from warehouse_operations.calibrate import breakdowns
from warehouse_operations.calibrate.bag import LEAST, Lifts, Look
from warehouse_operations.calibrate.recording import (
    NOWHERE,
    CalibrationError,
    Recording,
    Track,
    named,
    require,
)

ZSTD = b"\x28\xb5\x2f\xfd"
LINE = 'a JSON object with "time", "topic" and "payload" was expected'
BINARY = "payload_base64"  # of a payload that is no text
KINDS = ("state", "visualization")
# What an error says of the failures of robots; others that are fatal are OTHER, unless they are of
# orders, or of a battery that will be charged.
ERRORS = {
    "motorError": "motor",
    "liftError": "lift_stuck",
    "laserError": "laser_blind",
    "wheelSlip": "wheel_slips",
}
NO_FAILURE = ("batteryEmpty", "noOrderToCancel", "noRouteError", "validationError")
OF_ORDERS = ("order", "instantAction")  # begin of their names
FATAL = ("FATAL", "CRITICAL")
LIFTS = ("pick", "drop")
RUNNING = ("INITIALIZING", "RUNNING")
OFTEN = 1000  # lines between two looks


def is_log(path: Path) -> bool:
    """Returns whether a file begins as a log does."""
    with path.open("rb") as file:
        head = file.read(16)
    return head.startswith(ZSTD) or head.lstrip().startswith(b"{")


def read(path: Path, look: Look = lambda *_: None) -> Recording:
    """Returns the Recording of a log. Raises CalibrationError with file and line."""
    reader, size, kinds, count = _Reader(), path.stat().st_size, set(), 0
    with _lines(path) as (lines, file):
        for number, line in enumerate(lines, 1):
            if not line.strip():
                continue
            where = f"{path}:{number}"
            try:
                topic, value, time = _message(line, where)
            except CalibrationError:
                if count and not line.endswith("\n"):
                    break  # the recorder was killed within it
                raise
            count += 1
            kinds.add(topic.rpartition("/")[2])
            reader.take(topic, value, time, where)
            if number % OFTEN == 0:
                look(file.tell() / max(size, 1), f"{path.name}: {number} messages")
    require(count > 0, f"{path}: is empty; {LINE}")
    require(
        bool(kinds & set(KINDS)),
        f"{path}: has no topic 'state' or 'visualization' among {named(kinds)}: a log of what "
        "vehicles send was expected",
    )
    out = reader.recording()
    require(
        bool(out.tracks or out.lifts),
        f"{path}: states of {reader.vehicles} vehicles, none with {LEAST} positions; agvPosition "
        "and velocity in their states were expected",
    )
    out.sources = [f"{path}: {len(out.tracks)} vehicles, {count} messages"]
    return out


@contextmanager
def _lines(path: Path) -> Iterator[tuple[Iterator[str], Any]]:
    """Yields the lines of a log, and the file that is read."""
    with path.open("rb") as file:
        stream: Any = file
        if file.read(len(ZSTD)) == ZSTD:
            try:
                import zstandard
            except ImportError as error:
                raise CalibrationError(
                    f"{path}: is compressed by zstd, which takes Debian's python3-zstandard"
                ) from error
            file.seek(0)
            stream = zstandard.ZstdDecompressor().stream_reader(file, read_across_frames=True)
            errors: tuple[type[Exception], ...] = (UnicodeDecodeError, zstandard.ZstdError)
        else:
            file.seek(0)
            errors = (UnicodeDecodeError,)
        try:
            yield iter(io.TextIOWrapper(stream, encoding="utf-8")), file
        except errors as error:
            raise CalibrationError(f"{path}: {error}; a whole log was expected") from error


def _message(line: str, where: str) -> tuple[str, dict[str, Any] | None, float]:
    """Returns topic, content and time [s] of a line; no content: its payload is no JSON object,
    which a log of what went wrong may hold."""
    try:
        entry = json.loads(line)
        topic, time = str(entry["topic"]), float(entry["time"])
        payload = "" if BINARY in entry else entry["payload"]
    except (ValueError, KeyError, TypeError) as error:
        raise CalibrationError(f"{where}: {line.strip()[:60]!r}; {LINE}") from error
    if isinstance(payload, str):
        try:
            payload = json.loads(payload)
        except ValueError:
            payload = None
    return topic, payload if isinstance(payload, dict) else None, time


class _Reader:
    """Gathers the rows of vehicles."""

    def __init__(self) -> None:
        self._rows: dict[str, list[list[float]]] = defaultdict(list)
        self._lifts: dict[str, Lifts] = defaultdict(Lifts)
        # Of the last state: loaded, charge, failures, lifting.
        self._of_state: dict[str, tuple[float, float, float, float]] = {}

    @property
    def vehicles(self) -> int:
        """The number of vehicles that sent states."""
        return len(self._of_state)

    def take(self, topic: str, value: dict[str, Any] | None, time: float, where: str) -> None:
        """Takes in a message. Raises CalibrationError for a field of another type."""
        prefix, _, kind = topic.rpartition("/")
        if value is None or kind not in KINDS:
            return
        vehicle = prefix or f"{value.get('manufacturer', '')}/{value.get('serialNumber', '')}"
        try:
            time = _time(value, time)
            if kind == "state":
                self._of_state[vehicle] = self._state(vehicle, value, time)
            row = _motion(value, time, self._of_state.get(vehicle))
        except (TypeError, ValueError, AttributeError, KeyError) as error:
            raise CalibrationError(
                f"{where}: {topic}: {error}; a message of VDA 5050 was expected"
            ) from error
        if row is not None:
            self._rows[vehicle].append(row)

    def _state(
        self, vehicle: str, value: dict[str, Any], time: float
    ) -> tuple[float, float, float, float]:
        lifting = False
        for action in value.get("actionStates", ()):
            if action.get("actionType") not in LIFTS:
                continue
            runs = action["actionStatus"] in RUNNING
            lifting |= runs
            key = f"{vehicle}/{action['actionId']}"
            if key not in self._lifts and vehicle in self._of_state:
                self._lifts[key].note(vehicle, time, False)  # it was not under way before
            self._lifts[key].note(vehicle, time, runs)
        battery = value.get("batteryState") or value.get("powerSupply") or {}
        charge = battery.get("batteryCharge", battery.get("stateOfCharge"))
        return (
            float(bool(value.get("loads"))),
            NOWHERE if charge is None else float(charge) / 100,
            float(_failures(value.get("errors", ()))),
            float(lifting),
        )

    def recording(self) -> Recording:
        """Returns what was recorded."""
        out = Recording()
        for vehicle, rows in self._rows.items():
            if len(rows) >= LEAST:
                out.tracks[vehicle] = Track.of_rows(rows)
                breakdowns.note(out, out.tracks[vehicle])
        out.lifts = [time for lifts in self._lifts.values() for time in lifts.durations]
        return out


def _time(value: dict[str, Any], otherwise: float) -> float:
    """Returns when a message was sent [s], by its header; otherwise when it came."""
    stamp = value.get("timestamp")
    return datetime.fromisoformat(stamp).timestamp() if stamp else otherwise


def _motion(
    value: dict[str, Any], time: float, state: tuple[float, float, float, float] | None
) -> list[float] | None:
    """Returns a row of a Track; None without a position or a speed."""
    at = value.get("agvPosition") or value.get("mobileRobotPosition")
    velocity = value.get("velocity")
    if not at or velocity is None:
        return None
    loaded, charge, failures, lifting = state or (0.0, NOWHERE, 0.0, 0.0)
    speed = math.hypot(velocity.get("vx", 0.0), velocity.get("vy", 0.0))
    turning = velocity.get("omega", 0.0)
    row = [time, at["x"], at["y"], at.get("theta", 0.0), speed, turning]
    return [*map(float, row), loaded, charge, failures, lifting]


def _failures(errors: Any) -> int:
    """Returns the bits of what is broken."""
    bits = 0
    for error in errors:
        kind = str(error.get("errorType", ""))
        if kind in ERRORS:
            bits |= breakdowns.BITS[ERRORS[kind]]
        elif error.get("errorLevel") in FATAL:
            is_of_order = kind in NO_FAILURE or kind.startswith(OF_ORDERS)
            bits |= 0 if is_of_order else breakdowns.OTHER
    return bits
