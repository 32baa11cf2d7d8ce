# SPDX-License-Identifier: Apache-2.0
"""Events as lines for a person at a terminal."""

import os
import re

from warehouse_msgs.msg import Event
from warehouse_sim.words import EVENT

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
# What a terminal would obey rather than show; models have the names that their files give them.
_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f]")


def word(event):
    return EVENT.get(event.kind, str(event.kind))


def line(event, coloured=False):
    """Time [s, simulated], model, what happened, which command, who else took part, and why."""
    number = f"#{event.command}" if event.command else ""
    kind = f"{word(event):<9}"
    if coloured:
        kind = f"\033[{COLOURS.get(event.kind, _DIM)}m{kind}\033[0m"
    model, other, text = map(_plain, (event.model, event.other, event.text))
    why = ": ".join(filter(None, (other, text)))
    return f"{event.header.stamp.to_sec():10.3f} s  {model:<14} {kind} {number:<6} {why}".rstrip()


def _plain(text):
    return _CONTROL.sub("?", text)


def fits(event, models=(), kinds=()):
    """Whether it is about one of the models, if any are named, and of one of these kinds."""
    about = not models or event.model in models or event.other in models
    return about and (not kinds or word(event).lower() in kinds)


def wants_colour(choice, file, environment=os.environ):
    """`choice` is always, never, or auto: on a terminal that shall have some."""
    if choice != "auto":
        return choice == "always"
    return file.isatty() and "NO_COLOR" not in environment and environment.get("TERM") != "dumb"
