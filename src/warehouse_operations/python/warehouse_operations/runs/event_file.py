# SPDX-License-Identifier: Apache-2.0
"""Events within a scenario: a list in a file of its own, in a sweep or in a scenario of what-if.

- {at: 600, close: pick3}          # [s] of the shift; or 2:30:00
- {at: 1:00:00, open: pick3}
- {at: 600, robots: +4}            # 4 more; -2: 2 fewer
- {at: 600, fail: robot 7}         # or a share, 10%; `for: 900` until it is repaired [s] (600)
- {at: 600, speed: 50%}            # of the robots' top speed; ideal robots only
- {at: 600, sku_out: red}          # its pieces are gone, and no more come
- {at: 600, orders: rush.csv}      # come besides the others, their times from then on
- {at: 600, picker: {station: pick1, seconds_a_piece: 14}}   # also pickers: 2
- {at: 600, priority: {order: rush-17, to: 5}}   # of an order that is open then
- {at: 600, policy: {storage: nearest}}  # roles with a policy each; see policies

A line says the same for one event: `+10m robots +2`, `2:30:00 close pick3`.
"""

import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from warehouse_layout.file.station_settings import StationSettingError, check_setting
from warehouse_operations.policies import Policies, PolicyError
from warehouse_operations.stock.lined_yaml import LinedYaml, Place, shown
from warehouse_operations.stock.order_file import DemandError, read_csv

LAST = 1e9  # [s]
REPAIR = 600.0  # time to the repair of a robot that fails [s]
MOST_ROBOTS = 20_000
MOST_EVENTS = 10_000
HIGHEST = 255  # priority
PICKER = ("seconds_a_piece", "pickers")
UNITS = {"": 1.0, "s": 1.0, "m": 60.0, "min": 60.0, "h": 3600.0}
EXPECTED = "close, open, robots, fail, speed, sku_out, orders, picker, priority or policy"


class EventError(ValueError):
    """Raised for an invalid event; names file, line and field."""


@dataclass(frozen=True)
class Event:
    """What happens at a time of the shift [s]. where: its file and line, for messages.

    value: a station's name (close, open), a number of robots (robots), a robot's id or a share
    below 1 of all (fail), a share of the top speed (speed), a SKU (sku_out), a path (orders), what
    is set at a station (picker), an order with its priority (priority), or policies by role
    (policy). duration: until robots that fail are repaired [s].
    """

    at: float
    kind: str
    value: Any
    duration: float = REPAIR
    where: str = field(default="", compare=False)

    def to_json(self) -> dict[str, Any]:
        """Returns the event in the form of a list in a file."""
        value = self.value
        if self.kind == "fail":
            value = f"robot {value}" if isinstance(value, int) else value
        more = {"for": self.duration} if self.kind == "fail" else {}
        return {"at": self.at, self.kind: value} | more

    def fault(self, text: str) -> EventError:
        """Returns the error about it."""
        return EventError(f"{self.where}{': ' if self.where else ''}{self.kind} {text}")


Fail = Callable[[Place, str], Exception]


def read(path: str | Path) -> tuple[Event, ...]:
    """Reads a YAML file with a list of events. Raises EventError."""
    file = LinedYaml(path, EventError)
    content: Any = file.content
    place: Place = ()
    if isinstance(content, dict) and content.keys() == {"events"}:
        content, place = content["events"], ("events",)
    return events_of(content, Path(path).parent, file.fault, place, str(path), file.line)


def events_of(
    content: Any,
    folder: Path,
    fail: Fail | None = None,
    place: Place = (),
    name: str = "events",
    line: Callable[[Place], int] | None = None,
) -> tuple[Event, ...]:
    """Returns the events of a list, by time. Raises EventError, or what `fail` makes of a place and
    a text. folder: of the files that are named. name, line: of the file, for messages."""
    fail = fail or _fault_without_file
    if content is None:
        return ()
    if not isinstance(content, list) or len(content) > MOST_EVENTS:
        raise fail(place, f"has to be a list of events, each with `at` and {EXPECTED}")
    events = []
    for i, entry in enumerate(content):
        here = (*place, i)
        where = f"{name}:{line(here)}" if line else f"{name}[{i}]"
        events.append(_Reader(entry, folder, fail, here, where).read())
    return tuple(sorted(events, key=lambda event: event.at))


def _fault_without_file(place: Place, text: str) -> EventError:
    fields = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in place)
    return EventError(f"events{fields}: {text}" if fields else f"events {text}")


def of_line(text: str, now: float = 0.0) -> Event:
    """Returns the event of a line: a time, or +TIME from now on, kind and value. Raises
    EventError."""
    words = text.split()
    if len(words) < 3:
        raise EventError(
            f"'{text}'; a time, {EXPECTED}, and a value were expected, as in 10m close pick1"
        )
    when, kind, *rest = words
    entry: dict[str, Any] = {kind: _value_of(kind, rest)}
    try:
        at = seconds_of(when.removeprefix("+"))
    except ValueError as error:
        raise EventError(f"'{text}': the time {error}") from error
    entry["at"] = at + (now if when.startswith("+") else 0.0)
    if kind == "fail" and len(rest) > 2 and rest[-2] == "for":
        entry |= {"fail": " ".join(rest[:-2]), "for": rest[-1]}

    def fail(place: Place, fault: str) -> EventError:
        return EventError(f"'{text}': {'.'.join(map(str, place))} {fault}")

    return _Reader(entry, Path(), fail, (), f"'{text}'").read()


def _value_of(kind: str, words: Sequence[str]) -> Any:
    first, *rest = words
    if kind == "picker":
        return {"station": first} | dict(zip(PICKER, map(plain, rest)))
    if kind == "priority":
        return {"order": " ".join(words[:-1]), "to": plain(words[-1])}
    if kind == "policy":
        return {first: " ".join(rest)}
    return " ".join(words)


def plain(text: str) -> Any:
    """Returns a number where a text is a number, else the text."""
    try:
        return int(text)
    except ValueError:
        pass
    try:
        return float(text)
    except ValueError:
        return text


def seconds_of(value: Any) -> float:
    """Returns a time [s]: a number, `10m`, `2h` or `2:30:00`. Raises ValueError."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        number = float(value)
    elif isinstance(value, str) and re.fullmatch(r"\d+(:[0-5]?\d){1,2}(\.\d+)?", value.strip()):
        number = 0.0
        for part in value.strip().split(":"):
            number = 60 * number + float(part)
    else:
        match = re.fullmatch(r"([0-9.]+)\s*(s|m|min|h|)", str(value).strip())
        try:
            number = float(match[1]) * UNITS[match[2]] if match else -1.0
        except ValueError:
            number = -1.0
    if not 0 <= number <= LAST:
        raise ValueError(f"is {shown(value)}; seconds of the shift, or 2:30:00, were expected")
    return number


class _Reader:
    """Reads one event."""

    def __init__(self, entry: Any, folder: Path, fail: Fail, place: Place, where: str) -> None:
        self._entry, self._folder, self._place = entry, folder, place
        self._fail, self._where = fail, where

    def read(self) -> Event:
        """Returns the event. Raises what `fail` makes."""
        entry = self._entry
        if not isinstance(entry, dict):
            raise self._fail(self._place, f"is {shown(entry)}; `at` and {EXPECTED} were expected")
        if "at" not in entry:
            raise self._fail(self._place, "has no `at`: when it happens")
        try:
            at = seconds_of(entry["at"])
        except ValueError as error:
            raise self._fault("at", str(error)) from error
        kinds = [key for key in entry if key not in ("at", "for")]
        unknown = [key for key in kinds if key not in _VALUES]
        if unknown:
            raise self._fault(str(unknown[0]), f"is unknown; {EXPECTED} was expected")
        if len(kinds) != 1 or ("for" in entry and kinds != ["fail"]):
            raise self._fail(self._place, f"has to have one of {EXPECTED}; `for` goes with fail")
        kind = kinds[0]
        value = _VALUES[kind](self, entry[kind])
        return Event(at, kind, value, self._duration(), self._where)

    def _duration(self) -> float:
        try:
            return seconds_of(self._entry.get("for", REPAIR))
        except ValueError as error:
            raise self._fault("for", str(error)) from error

    def _fault(self, key: str, text: str) -> Exception:
        return self._fail((*self._place, key), text)

    def close(self, value: Any, key: str = "close") -> str:
        """Returns the name of a station."""
        if not isinstance(value, str) or not value:
            raise self._fault(key, f"is {shown(value)}; the name of a station was expected")
        return value

    def open(self, value: Any) -> str:
        """Returns the name of a station."""
        return self.close(value, "open")

    def robots(self, value: Any) -> int:
        """Returns the change of the number of robots."""
        number = plain(value) if isinstance(value, str) else value
        whole = isinstance(number, int) and not isinstance(number, bool)
        if not whole or not number or abs(number) > MOST_ROBOTS:
            text = f"is {shown(value)}; +4 or -2, for example, up to {MOST_ROBOTS:,}, was expected"
            raise self._fault("robots", text)
        return int(number)

    def fail(self, value: Any) -> int | float:
        """Returns a robot's id, or a share of all robots."""
        if isinstance(value, str) and (match := re.fullmatch(r"(?:robot|kiva)\s*(\d+)", value)):
            return int(match[1])
        share = _share(value)
        if share is None or not 0 < share <= 1:
            text = f"is {shown(value)}; `robot 7`, or a share as 10%, was expected"
            raise self._fault("fail", text)
        return share

    def speed(self, value: Any) -> float:
        """Returns a share of the top speed."""
        share = _share(value)
        if share is None or not 0.05 <= share <= 2:
            text = f"is {shown(value)}; a share of the top speed, 5% to 200%, was expected"
            raise self._fault("speed", text)
        return share

    def sku_out(self, value: Any) -> str:
        """Returns a SKU."""
        if isinstance(value, bool) or not isinstance(value, (str, int)) or value == "":
            raise self._fault("sku_out", f"is {shown(value)}; a SKU was expected")
        return str(value)

    def orders(self, value: Any) -> str:
        """Returns the whole path of a file of orders."""
        if not isinstance(value, str) or not value.endswith(".csv"):
            raise self._fault("orders", f"is {shown(value)}; a CSV file of orders was expected")
        path = os.path.abspath(self._folder / value)
        path = path if os.path.exists(path) else value
        try:
            read_csv(path)
        except DemandError as error:
            raise self._fault("orders", str(error)) from error
        return path

    def picker(self, value: Any) -> dict[str, Any]:
        """Returns the settings for a station."""
        known = {"station", *PICKER}
        if not isinstance(value, Mapping) or not value.keys() <= known or len(value) < 2:
            text = "has to be {station: pick1, seconds_a_piece: 14}, or pickers: 2"
            raise self._fault("picker", text)
        out: dict[str, Any] = {"station": self.close(value.get("station"), "picker")}
        for key in value.keys() - {"station"}:
            try:
                out[key] = check_setting(key, value[key])
            except StationSettingError as error:
                raise self._fault("picker", str(error)) from error
        return out

    def priority(self, value: Any) -> dict[str, Any]:
        """Returns an order's reference or number, and its priority from then on."""
        whole = isinstance(value, Mapping) and value.keys() == {"order", "to"}
        order, to = (value["order"], value["to"]) if whole else (None, None)
        if isinstance(order, bool) or not isinstance(order, (str, int)) or order == "":
            text = "has to be {order: rush-17, to: 5}, an order's reference or number"
            raise self._fault("priority", text)
        if isinstance(to, bool) or not isinstance(to, int) or not 0 <= to <= HIGHEST:
            raise self._fault("priority", f"to is {shown(to)}; 0 to {HIGHEST} was expected")
        return {"order": str(order), "to": to}

    def policy(self, value: Any) -> dict[str, Any]:
        """Returns policies by role."""
        if not isinstance(value, Mapping) or not value:
            text = f"is {shown(value)}; {{storage: nearest}}, for example, was expected"
            raise self._fault("policy", text)
        try:
            Policies(dict(value))
        except PolicyError as error:
            raise self._fault("policy", str(error).removeprefix("policies: ")) from error
        return dict(value)


_VALUES: dict[str, Callable[[_Reader, Any], Any]] = {
    "close": _Reader.close,
    "open": _Reader.open,
    "robots": _Reader.robots,
    "fail": _Reader.fail,
    "speed": _Reader.speed,
    "sku_out": _Reader.sku_out,
    "orders": _Reader.orders,
    "picker": _Reader.picker,
    "priority": _Reader.priority,
    "policy": _Reader.policy,
}


def _share(value: Any) -> float | None:
    if isinstance(value, str) and (match := re.fullmatch(r"([0-9.]+)\s*%", value.strip())):
        number = plain(match[1])
        return float(number) / 100 if isinstance(number, (int, float)) else None
    number = plain(value) if isinstance(value, str) else value
    return float(number) if isinstance(number, (int, float)) and number is not True else None


def most_added(events: Sequence[Event]) -> int:
    """Returns the largest number of robots above the initial one."""
    most = count = 0
    for event in events:
        if event.kind == "robots":
            count += event.value
            most = max(most, count)
    return most
