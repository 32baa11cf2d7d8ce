# SPDX-License-Identifier: Apache-2.0
"""Text of replies: quoted data, numbers as people read them, replies of bounded length."""

import json
import secrets
import unicodedata
from collections import OrderedDict
from collections.abc import Iterable

MOST_REPLY = 2000  # [bytes]
MOST_KEPT = 500  # rests of long replies
MOST_REST = 100_000  # [bytes] of each
MOST_QUOTED = 120  # characters of a text from data


def plain(text: object, most: int = MOST_QUOTED) -> str:
    """Returns one line of a text: control and formatting characters become spaces."""
    whole = str(text)
    line = "".join(" " if unicodedata.category(c)[0] in "CZ" else c for c in whole[: 2 * most])
    line = " ".join(line.split())
    return line if len(line) <= most and len(whole) <= 2 * most else line[: most - 1] + "…"


def quoted(text: object, most: int = MOST_QUOTED) -> str:
    """Returns a text from data, in quotation marks and on one line."""
    return json.dumps(plain(text, most), ensure_ascii=False)


def sentence(text: str) -> str:
    """Returns a text with a full stop at its end."""
    return text if text.endswith((".", "!", "?", "…")) else f"{text}."


def count(number: int, noun: str) -> str:
    """Returns "1 robot", "2 robots"."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def listed(texts: Iterable[object], most: int = 12) -> str:
    """Returns texts with commas between, and the number left out."""
    every = [str(text) for text in texts]
    rest = len(every) - most
    return ", ".join(every[:most]) + (f" and {rest} more" if rest > 0 else "")


def duration(seconds: float) -> str:
    """Returns a duration as people read it."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


class Replies:
    """Keeps the rest of each long reply under a key, which `more` takes."""

    def __init__(self, most: int = MOST_REPLY) -> None:
        self._most = most
        self._rests: OrderedDict[str, str] = OrderedDict()

    def bounded(self, text: str) -> str:
        """Returns a text of at most `most` bytes: a longer one's beginning, and how to go on."""
        # Characters that UTF-8 can't encode become question marks.
        data = text.encode("utf-8", "replace")
        if len(data) <= self._most:
            return data.decode("utf-8")
        head = data[: self._most - 120].decode("utf-8", "ignore")
        line = head.rfind("\n")
        if line > len(head) // 2:
            head = head[: line + 1]
        rest = data[len(head.encode()) : MOST_REST].decode("utf-8", "ignore")
        key = secrets.token_urlsafe(6)
        self._rests[key] = rest
        while len(self._rests) > MOST_KEPT:
            self._rests.popitem(last=False)
        return f'{head.rstrip()}\n[{len(rest)} more characters: call more with key "{key}"]'

    def rest(self, key: str) -> str | None:
        """Returns the rest under a key, or None."""
        return self._rests.get(key)
