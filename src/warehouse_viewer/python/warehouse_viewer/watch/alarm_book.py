# SPDX-License-Identifier: Apache-2.0
"""The alarms that hold now: since when, and which person saw them."""

import threading
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import count
from typing import Any, NamedTuple

from warehouse_viewer.watch.alarm_kinds import KINDS, SEVERITIES


class Trouble(NamedTuple):
    """Something of a kind in KINDS that holds now. `subject`: whom it concerns; `since` [s],
    simulated: when it began, if that is known better than by its first mention."""

    kind: str
    subject: str
    text: str
    since: float | None = None


@dataclass
class Alarm:
    """A Trouble with its number and the person that saw it; times are simulated [s]."""

    trouble: Trouble
    since: float
    number: int = field(default_factory=count(1).__next__)
    seen_by: str = ""
    seen_at: float = 0.0

    def is_due(self, now: float) -> bool:
        """Whether it has lasted long enough to be told."""
        return now - self.since >= KINDS[self.trouble.kind].after

    def told(self) -> dict[str, Any]:
        """Returns the alarm as JSON has it."""
        kind, subject, text, _ = self.trouble
        about = KINDS[kind]
        return {
            "id": self.number,
            "kind": kind,
            "severity": about.severity,
            "title": about.title,
            "subject": subject,
            "text": text,
            "to_do": about.to_do,
            "since": round(self.since, 1),
            "seen_by": self.seen_by,
            "seen_at": round(self.seen_at, 1),
        }


class AlarmBook:
    """Alarms by kind and subject, for as long as each lasts. Any thread may call."""

    def __init__(self) -> None:
        self._lock, self._alarms = threading.Lock(), dict[tuple[str, str], Alarm]()
        self._now = 0.0

    def update(self, now: float, troubles: Iterable[Trouble]) -> None:
        """Takes in all that is wrong at `now` [s]: what is left out has ended."""
        with self._lock:
            before, self._alarms, self._now = self._alarms, {}, now
            for trouble in troubles:
                key = trouble.kind, trouble.subject
                since = now if trouble.since is None else trouble.since
                alarm = before.get(key) or self._alarms.get(key) or Alarm(trouble, since)
                alarm.trouble, alarm.since = trouble, min(alarm.since, since)
                if alarm.since > now:  # the world was reset meanwhile
                    alarm.since = now
                self._alarms[key] = alarm

    def told(self) -> list[dict[str, Any]]:
        """Returns the alarms as JSON has them, the worst first, of those the oldest first."""
        with self._lock:
            due = [alarm.told() for alarm in self._alarms.values() if alarm.is_due(self._now)]
        return sorted(due, key=lambda row: (SEVERITIES.index(row["severity"]), row["since"]))

    def see(self, number: int, by: str) -> dict[str, Any] | None:
        """Notes that a person has seen an alarm, or, with an empty name, takes that back. Returns
        the alarm as JSON has it; None if it has ended."""
        with self._lock:
            for alarm in self._alarms.values():
                if alarm.number == number:
                    alarm.seen_by, alarm.seen_at = by, self._now if by else 0.0
                    return alarm.told()
        return None
