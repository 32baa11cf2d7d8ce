# SPDX-License-Identifier: Apache-2.0
"""The sentences that held for robots and stations, each with since when."""

from collections.abc import Set
from sys import intern

import numpy as np

KEPT = 60  # sentences of a robot or station
BLOCK = 16  # names for which memory is taken where more come than were expected


class SentenceLog:
    """The newest KEPT sentences of each name, in arrays that are taken for all names at once.

    Times are simulated [s]. Equal texts are one object, which goes with its last place: `intern`
    has them without the name, so that robots share them. One thread at a time.
    """

    def __init__(self) -> None:
        self._rows: dict[str, int] = {}
        self._counts: list[int] = []  # of the sentences that each row ever had
        self._since = np.zeros((0, KEPT))
        self._texts = np.full((0, KEPT), "", object)

    def expect(self, names: int) -> None:
        """Allocates rows for the sentences of `names` names."""
        more = names - len(self._since)
        if more > 0:
            self._since = np.concatenate((self._since, np.full((more, KEPT), 0.0)))
            self._texts = np.concatenate((self._texts, np.full((more, KEPT), "", object)))

    @property
    def names(self) -> Set[str]:
        """Every name that has had a sentence."""
        return self._rows.keys()

    def note(self, name: str, time: float, sentence: str) -> None:
        """Adds what holds from now on, unless it is what held before."""
        text = sentence.removeprefix(f"{name} ")
        row = self._rows.setdefault(name, len(self._rows))
        if row == len(self._counts):
            self._counts.append(0)
            if row == len(self._since):
                self.expect(row + BLOCK)
        count = self._counts[row]
        if count and self._texts[row, (count - 1) % KEPT] == text:
            return
        self._since[row, count % KEPT], self._texts[row, count % KEPT] = time, intern(text)
        self._counts[row] += 1

    def since(self, name: str, text: str) -> float | None:
        """Returns since when a name's newest sentence has held; None if the text is not in it."""
        row = self._rows.get(name)
        if row is None:
            return None
        place = row, (self._counts[row] - 1) % KEPT
        return float(self._since[place]) if text in self._texts[place] else None

    def at(self, name: str, time: float) -> str:
        """Returns the sentence that held at a time; empty where none did or it is forgotten."""
        row = self._rows.get(name)
        count = 0 if row is None else self._counts[row]
        for i in range(count - 1, max(count - KEPT, 0) - 1, -1):
            if self._since[row, i % KEPT] <= time:
                text = self._texts[row, i % KEPT]
                return f"{name} {text}" if text else ""
        return ""
