# SPDX-License-Identifier: Apache-2.0
"""The alarms that hold now and those that have ended: since when, and what people did."""

import threading
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple

from warehouse_viewer.watch.alarm_kinds import KINDS, SEVERITIES

KEPT = 500  # alarms that have ended
MOST_ACTIONS = 50  # of an alarm
GRACE = 10.0  # for which an alarm that was restored needs no confirmation [s, simulated]
REPAIRED = "ROBOT_BROKEN"  # alarms whose mean duration is the time to repair
# Kinds that share one alarm for each robot.
OF_ROBOT = ("ROBOT_BROKEN", "ROBOT_LOST", "ROBOT_STALLED", "ROBOT_BLOCKED", "COLLISION")


class Trouble(NamedTuple):
    """Something of a kind in KINDS that holds now.

    subject: whom it concerns. since [s], simulated: when it began, if that is known better than by
    its first mention. consequences: sentences, each with its short form before the colon.
    queue: how many robots wait for it.
    """

    kind: str
    subject: str
    text: str
    since: float | None = None
    consequences: tuple[str, ...] = ()
    queue: int = 0

    @property
    def headline(self) -> str:
        """The cause with its consequences, in a sentence."""
        short = [text.partition(": ")[0] for text in self.consequences]
        return f"{self.text}: {', '.join(short)}" if short else self.text

    @property
    def key(self) -> tuple[str, str]:
        """What stays the same as long as it is the same alarm."""
        return ("" if self.kind in OF_ROBOT else self.kind), self.subject


class Action(NamedTuple):
    """What a person did about an alarm at a simulated time [s]."""

    time: float
    by: str
    what: str


@dataclass
class Alarm:
    """A Trouble with its number and what people did; times are simulated [s]."""

    trouble: Trouble
    since: float
    number: int
    seen_by: str = ""
    seen_at: float = 0.0
    actions: list[Action] = field(default_factory=list)
    is_reported: bool = False  # by AlarmBook.begun()

    def is_due(self, now: float) -> bool:
        """Whether it has lasted long enough to be an alarm."""
        return now - self.since >= KINDS[self.trouble.kind].after

    def as_json(self, remedies: Iterable[Any] = ()) -> dict[str, Any]:
        """Returns the alarm as JSON; `remedies`: named tuples."""
        trouble, about = self.trouble, KINDS[self.trouble.kind]
        return {
            "id": self.number,
            "kind": trouble.kind,
            "severity": about.severity,
            "title": about.title,
            "subject": trouble.subject,
            "text": trouble.headline,
            "cause": trouble.text,
            "consequences": list(trouble.consequences),
            "to_do": about.to_do,
            "remedies": [remedy._asdict() for remedy in remedies],
            "since": round(self.since, 1),
            "seen_by": self.seen_by,
            "seen_at": round(self.seen_at, 1),
            "actions": [action._asdict() for action in self.actions],
        }


class AlarmBook:
    """Alarms for as long as each lasts, and the last KEPT that have ended. Any thread may call.

    remedies(trouble): what can be done about a Trouble now, as named tuples.
    """

    def __init__(self, remedies: Callable[[Trouble], Iterable[Any]] = lambda _: ()) -> None:
        self._lock, self._alarms = threading.Lock(), dict[tuple[str, str], Alarm]()
        self._ended: deque[dict[str, Any]] = deque(maxlen=KEPT)
        self._remedies, self._now = remedies, 0.0
        self._last = 0  # number of an alarm
        self._just_ended: list[dict[str, Any]] = []
        self._restored_until: float | None = None
        self.changes = 0  # of what state() returns

    def update(self, now: float, troubles: Iterable[Trouble]) -> None:
        """Updates from all troubles at `now` [s]: those that are left out have ended."""
        with self._lock:
            before, self._alarms, self._now = self._alarms, {}, now
            for trouble in troubles:
                key = trouble.key
                since = now if trouble.since is None else trouble.since
                alarm = before.pop(key, None) or self._alarms.get(key) or self._new(trouble, since)
                alarm.trouble, alarm.since = trouble, min(alarm.since, since)
                if alarm.since > now:  # the world was reset meanwhile
                    alarm.since = now
                self._alarms[key] = alarm
            for key, alarm in before.items():
                if self._waits_for_news(now):
                    self._alarms[key] = alarm
                elif alarm.is_due(now):
                    self._end(alarm, now)

    def _new(self, trouble: Trouble, since: float) -> Alarm:
        self._last += 1
        self.changes += 1
        return Alarm(trouble, since, self._last)

    def _end(self, alarm: Alarm, now: float) -> None:
        until = {"until": round(now, 1), "duration": round(now - alarm.since, 1)}
        self._ended.append(alarm.as_json() | until)
        self._just_ended.append(self._ended[-1])
        self.changes += 1

    def _waits_for_news(self, now: float) -> bool:
        """Whether alarms were restored a moment ago: what raised them may not be known yet."""
        if self._restored_until is None:
            return False
        if self._restored_until == 0.0:
            self._restored_until = now + GRACE
        return now < self._restored_until

    def news(self) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
        """Returns the alarms that have become due and those that have ended, since the last call,
        as JSON."""
        with self._lock:
            due = [alarm for alarm in self._alarms.values() if alarm.is_due(self._now)]
            begun = [alarm for alarm in due if not alarm.is_reported]
            for alarm in begun:
                alarm.is_reported = True
            ended, self._just_ended = self._just_ended, []
            return [alarm.as_json(self._remedies(alarm.trouble)) for alarm in begun], ended

    def state(self) -> dict[str, Any]:
        """Returns all that restore() needs, as JSON."""
        with self._lock:
            return {
                "last": self._last,
                "now": self._now,
                "alarms": [asdict(alarm) | _parts(alarm) for alarm in self._alarms.values()],
                "ended": list(self._ended),
            }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Goes on from a state(): who saw and did what, and the alarms that have ended. Raises
        KeyError, TypeError or ValueError for an invalid state."""
        alarms = [_alarm_of(row) for row in state["alarms"]]
        ended = [dict(row) for row in state["ended"]]
        last, now = int(state["last"]), float(state["now"])
        with self._lock:
            self._alarms = {alarm.trouble.key: alarm for alarm in alarms}
            self._ended.extend(ended)
            self._last, self._now, self._restored_until = last, now, 0.0

    def as_json(self) -> list[dict[str, Any]]:
        """Returns the alarms as JSON, the worst first, of those the oldest first."""
        with self._lock:
            due = [
                alarm.as_json(self._remedies(alarm.trouble))
                for alarm in self._alarms.values()
                if alarm.is_due(self._now)
            ]
        return sorted(due, key=lambda row: (SEVERITIES.index(row["severity"]), row["since"]))

    def history(self) -> list[dict[str, Any]]:
        """Returns the alarms that have ended as JSON, the newest first."""
        with self._lock:
            return list(reversed(self._ended))

    def time_to_repair(self) -> tuple[int, float]:
        """Returns how many broken robots were repaired, and how long it took on the average [s]."""
        with self._lock:
            spans = [row["duration"] for row in self._ended if row["kind"] == REPAIRED]
        return len(spans), sum(spans) / max(len(spans), 1)

    def see(self, number: int, by: str) -> dict[str, Any] | None:
        """Notes that a person has seen an alarm, or, with an empty name, takes that back. Returns
        the alarm as JSON has it; None if it has ended."""
        with self._lock:
            for alarm in self._alarms.values():
                if alarm.number == number:
                    alarm.seen_by, alarm.seen_at = by, self._now if by else 0.0
                    self.changes += 1
                    return alarm.as_json(self._remedies(alarm.trouble))
        return None

    def note(self, subject: str, by: str, what: str) -> None:
        """Notes what a person did about a robot, item or station, in the alarms that concern it."""
        with self._lock:
            for alarm in self._alarms.values():
                if alarm.trouble.subject == subject and len(alarm.actions) < MOST_ACTIONS:
                    alarm.actions.append(Action(round(self._now, 1), by, what))
                    self.changes += 1


def _parts(alarm: Alarm) -> dict[str, Any]:
    actions = [action._asdict() for action in alarm.actions]
    return {"trouble": alarm.trouble._asdict(), "actions": actions}


def _alarm_of(row: Mapping[str, Any]) -> Alarm:
    fields = dict(row["trouble"])
    trouble = Trouble(**fields | {"consequences": tuple(fields["consequences"])})
    if trouble.kind not in KINDS:
        raise ValueError(f"no kind of alarms {trouble.kind}")
    actions = [Action(**action) for action in row["actions"]]
    return Alarm(**dict(row) | {"trouble": trouble, "actions": actions, "is_reported": False})
