# SPDX-License-Identifier: Apache-2.0
"""Events as lines for a person at a terminal."""

import os
import re
from collections import Counter
from collections.abc import Collection, Mapping
from typing import TextIO

from warehouse_client.message_names import EVENT
from warehouse_layout.models.models import kind_and_number
from warehouse_msgs.msg import Event

_GREEN, _YELLOW, _RED, _BLUE, _DIM = 32, 33, 31, 34, 2
COLOURS = {
    Event.REFUSED: _YELLOW,
    Event.DONE: _GREEN,
    Event.BLOCKED: _RED,
    Event.COLLISION: _RED,
    Event.LOST: _RED,
    Event.LIFTED: _BLUE,
    Event.DROPPED: _BLUE,
    Event.FAILED: _RED,
    Event.REPAIRED: _GREEN,
    Event.TIPPED: _RED,
    Event.FELL: _RED,
    Event.PICKED_UP: _GREEN,
}
# Control characters of terminals; names of models come from any file.
_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f]")


def word(event: Event) -> str:
    """Returns the word for an event's kind."""
    return EVENT.get(event.kind, str(event.kind))


def line(event: Event, coloured: bool = False) -> str:
    """Returns a line: time [s, simulated], model, kind, command, the other model, reason."""
    number = f"#{event.command}" if event.command else ""
    kind = _kind(event, coloured)
    model, other, text = map(_plain, (event.model, event.other, event.text))
    named = other and text.startswith(other)  # "kiva2 is in the way" names it itself
    why = text if named else ": ".join(filter(None, (other, text)))
    return f"{event.header.stamp.to_sec():10.3f} s  {model:<14} {kind} {number:<6} {why}".rstrip()


def _kind(event: Event, coloured: bool) -> str:
    kind = f"{word(event):<9}"
    return f"\033[{COLOURS.get(event.kind, _DIM)}m{kind}\033[0m" if coloured else kind


SUMMED = (Event.SPAWNED, Event.DELETED)
FEW = 3  # in a row that have a line each
_NOUNS = {
    "kiva": "robot",
    "storage_unit": "storage unit",
    "item": "item",
    "conveyor_belt": "conveyor belt",
}


class EventLines:
    """The lines of events; many models that come or go in a row share a line.

    take() and rest() return the lines to print now; call rest() after a while without events.
    `each`: every event has a line.
    """

    def __init__(self, coloured: bool = False, each: bool = False) -> None:
        self._coloured, self._each = coloured, each
        self._row: list[Event] = []

    def take(self, event: Event) -> list[str]:
        """Adds an Event; returns the lines that are complete."""
        if self._each or event.kind not in SUMMED:
            return [*self.rest(), line(event, self._coloured)]
        lines = self.rest() if self._row and self._row[0].kind != event.kind else []
        self._row.append(event)
        return lines

    def rest(self) -> list[str]:
        """Returns the lines of pending events."""
        row, self._row = self._row, []
        if len(row) <= FEW:
            return [line(event, self._coloured) for event in row]
        models = f"{len(row)} models"
        time, kind = row[-1].header.stamp.to_sec(), _kind(row[-1], self._coloured)
        return [f"{time:10.3f} s  {models:<14} {kind} {'':<6} {_counted(row)}"]


def _counted(row: list[Event]) -> str:
    """How many of each kind, as "4 robots, 24 storage units"."""
    nouns = (_NOUNS.get(kind_and_number(event.model)[0] or "", "other model") for event in row)
    counts = Counter(nouns)
    order = [*_NOUNS.values(), "other model"]
    counted = ((counts[noun], noun) for noun in order if counts[noun])
    return ", ".join(f"{n} {noun}{'' if n == 1 else 's'}" for n, noun in counted)


def _plain(text: str) -> str:
    return _CONTROL.sub("?", text)


def fits(event: Event, models: Collection[str] = (), kinds: Collection[str] = ()) -> bool:
    """Returns whether an event is about one of the models and of one of the kinds; empty: any."""
    about = not models or event.model in models or event.other in models
    return about and (not kinds or word(event).lower() in kinds)


def wants_colour(choice: str, file: TextIO, environment: Mapping[str, str] = os.environ) -> bool:
    """Returns whether to colour; `choice` is always, never, or auto: on a terminal with colours."""
    if choice != "auto":
        return choice == "always"
    return file.isatty() and "NO_COLOR" not in environment and environment.get("TERM") != "dumb"
