# SPDX-License-Identifier: Apache-2.0
"""Failures and repairs: how often robots break, how long repairs take, and of what kinds."""

from collections import Counter
from dataclasses import dataclass

import numpy as np

from warehouse_operations.calibrate.estimates import Finding, mean_duration, rate
from warehouse_operations.calibrate.recording import Recording, Track
from warehouse_operations.fleets.availability import HOUR, KINDS

BITS = {kind: 1 << number for number, kind in enumerate(KINDS, 1)}  # of FleetState.failures
OTHER = 64  # an error of the robot's own
ANY_OTHER = "other"


@dataclass(frozen=True)
class Breakdowns:
    """Failures per robot hour, mean time of a repair [s], and the number of each kind; None where
    kinds are not known."""

    per_robot_hour: Finding
    repair_time: Finding
    kinds: dict[str, int] | None


def of_recording(recording: Recording) -> Breakdowns:
    """Returns the Breakdowns of a Recording."""
    kinds = Counter(kind for kind in recording.failures if kind in BITS)
    count = len(recording.failures)
    return Breakdowns(
        rate(count, recording.robot_hours, f"failures in {recording.robot_hours:.1f} robot hours"),
        mean_duration(recording.repairs, recording.unrepaired, "repairs"),
        dict(kinds) if count and sum(kinds.values()) == count else None,
    )


def note(recording: Recording, track: Track) -> None:
    """Adds the failures of a track, and its hours, to its Recording."""
    recording.of_figures = False
    recording.robot_hours += float(track.time[-1] - track.time[0]) / HOUR
    for kind, bit in {**BITS, ANY_OTHER: OTHER}.items():
        broken = (track.failures & bit) > 0
        changes = np.diff(broken.astype(int), prepend=int(broken[0]))
        began = track.time[changes > 0].tolist()
        ended = track.time[changes < 0].tolist()
        recording.failures += [kind] * len(began)
        if broken[0]:  # since an unknown time
            ended = ended[1:]
        recording.repairs += [end - begin for begin, end in zip(began, ended)]
        if len(began) > len(ended):
            recording.unrepaired += float(track.time[-1]) - began[-1]
