# SPDX-License-Identifier: Apache-2.0
"""What the program `calibrate` does: reads recordings, finds parameters, writes a file."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from warehouse_layout.cli.progress_line import ProgressLine
from warehouse_operations.calibrate import (
    bag,
    battery,
    breakdowns,
    messages,
    motion,
    realism_file,
    service,
    shift_database,
)
from warehouse_operations.calibrate.estimates import (
    Estimate,
    Finding,
    TooLittle,
    edited_mean,
    resampled,
    shorth,
)
from warehouse_operations.calibrate.realism_file import Line
from warehouse_operations.calibrate.recording import CalibrationError, Recording
from warehouse_operations.fleets.availability import KINDS
from warehouse_operations.store.engines import DatabaseError

ERRORS = (CalibrationError, DatabaseError)
EXPECTED = "a rosbag, a log of VDA 5050 messages or the database of a shift was expected"
LIFTS = 8  # of an estimate
NO_ANSWER = 2  # exit code


class NothingFoundError(Exception):
    """Raised for recordings that determine no parameter; says what each lacks."""


def read(sources: Sequence[str]) -> Recording:
    """Returns what all sources hold together, with a progress line. Raises one of ERRORS."""
    line, out = ProgressLine(), Recording()

    def look(share: float, text: str) -> None:
        if line.is_due():
            line.show(share, text)

    try:
        for source in sources:
            out.add(_of_source(source, look))
    finally:
        line.replace("")
    return out


def _of_source(source: str, look: bag.Look) -> Recording:
    if "://" in source:
        return shift_database.read(source)
    path = Path(source)
    try:
        if path.is_dir():
            path /= "messages.jsonl"  # of conform
            if not path.is_file():
                raise CalibrationError(f"{source}: is a folder without messages.jsonl; {EXPECTED}")
        if not path.stat().st_size:
            raise CalibrationError(f"{source}: is empty; {EXPECTED}")
        if bag.is_bag(path):
            return bag.read(path, look)
        if shift_database.is_database(path):
            return shift_database.read(str(path))
        if messages.is_log(path):
            return messages.read(path, look)
    except OSError as error:
        raise CalibrationError(f"{source}: {error.strerror}") from error
    raise CalibrationError(f"{source}: is none of what is read; {EXPECTED}")


def findings(recording: Recording, capacity: float) -> list[Line]:
    """Returns all that a Recording says, in the order of a file. capacity: of batteries [Wh]."""
    tracks = list(recording.tracks.values())
    return [
        *_of_motion(motion.of_tracks(tracks), _lift(recording)),
        *_of_energy(battery.of_tracks(tracks, capacity), capacity),
        *_of_failures(breakdowns.of_recording(recording)),
        *_of_service(*service.of_recording(recording)),
    ]


def _lift(recording: Recording) -> Finding:
    """Returns the time of a lift. Looks that are apart see it begin late and end late: the mean is
    known up to half of a step at either end, which more lifts don't mend where looks and robots
    keep step."""
    step = recording.lift_step
    lift = resampled(recording.lifts, LIFTS, "lifts", edited_mean if step else shorth)
    if isinstance(lift, TooLittle):
        return lift
    return replace(lift, low=lift.low - step, high=lift.high + step)


def _of_motion(robots: motion.Motion, lift: Finding) -> list[Line]:
    rows: list[tuple[str, str, str, Finding]] = [
        ("speed", "speed", "m/s", robots.speed),
        ("acceleration", "acceleration", "m/s²", robots.acceleration),
        ("", "speeding up", "m/s²", robots.speeding_up),
        ("", "braking", "m/s²", robots.braking),
        ("quarter_turn_time", "quarter turn", "s", robots.quarter_turn_time),
        ("", "top rate of a turn", "rad/s", robots.turn_rate),
        ("", "ramp of a turn", "rad/s²", robots.turn_acceleration),
        ("lift_time", "lift", "s", lift),
    ]
    return [Line("motion", *row) for row in rows]


def _of_energy(use: battery.Use, capacity: float) -> list[Line]:
    rows: list[tuple[str, str, str, Finding]] = [
        ("electronics", "electronics", "W", use.electronics),
        ("charge_power", "charging", "W", use.charge_power),
        ("charge_taper", "taper of charging", "", use.charge_taper),
        ("drive_efficiency", "efficiency of driving", "", use.drive_efficiency),
    ]
    lines = [Line("energy", *row) for row in rows]
    if any(isinstance(line.finding, Estimate) for line in lines):
        known = Estimate(capacity, capacity, capacity, 1, "number that was given, by --capacity")
        lines.insert(0, Line("energy", "capacity", "capacity", "Wh", known))
    return lines


def _of_failures(breaks: breakdowns.Breakdowns) -> list[Line]:
    lines = [
        Line("failures", "per_robot_hour", "failures", "1/h", breaks.per_robot_hour),
        Line("failures", "repair_time", "repair", "s", breaks.repair_time),
    ]
    if breaks.kinds:
        count = sum(breaks.kinds.values())
        for kind in KINDS:
            share = breaks.kinds.get(kind, 0) / count
            # Shares by the rule of succession would never be 0; a file says what was counted.
            estimate = Estimate(share, share, share, breaks.kinds.get(kind, 0), "failures")
            lines.append(Line("failures", kind, f"share of {kind}", "", estimate))
    return lines


def _of_service(whole: service.Pace, by_station: dict[str, service.Pace]) -> list[Line]:
    lines = [
        Line("service", "seconds_a_piece", "a piece", "s", whole.piece, whole.deviation),
        Line("service", "pick_seconds", "handover", "s", whole.pick),
        Line("service", "seconds_a_line", "a line", "s", whole.line),
        Line("service", "seconds_a_bundle", "a bundle", "s", whole.bundle),
        Line("service", "", "exchange of units", "s", whole.exchange),
    ]
    for name, pace in by_station.items():
        row = ("service", "seconds_a_piece", "a piece", "s", pace.piece, pace.deviation)
        lines.append(Line(*row, station=name))
    return lines


def write(recording: Recording, capacity: float, out: Path) -> str:
    """Writes the file; returns the table. Raises NothingFoundError, CalibrationError."""
    lines = findings(recording, capacity)
    measured = [line for line in lines if isinstance(line.finding, Estimate) and line.key]
    if not measured:
        lacking = "; ".join(
            f"{line.name}: {line.finding}" for line in lines if isinstance(line.finding, TooLittle)
        )
        raise NothingFoundError(f"nothing can be said ({lacking})")
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        unfinished = out.with_name(out.name + ".new")
        unfinished.write_text(realism_file.text(lines, recording.sources), encoding="utf-8")
        unfinished.replace(out)
    except OSError as error:
        raise CalibrationError(f"{out}: {error.strerror}") from error
    return "\n".join([*recording.sources, "", realism_file.table(lines)])
