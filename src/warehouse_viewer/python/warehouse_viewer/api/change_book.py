# SPDX-License-Identifier: Apache-2.0
"""What has changed last, for readers that each follow at the pace they keep up with."""

import threading
from collections import defaultdict
from collections.abc import Hashable
from typing import Any

KEPT = 1000  # rows of a topic: what is newer than ten seconds, as far as readers may be behind


class ChangeBook:
    """The newest row of each key of a topic, in the order of changing.

    Any thread may note, any may read. A reader keeps the number up to which it has read.
    """

    def __init__(self, kept: int = KEPT) -> None:
        self._lock, self._kept, self.last = threading.Lock(), kept, 0
        self._rows: dict[str, dict[Hashable, Any]] = defaultdict(dict)
        self._forgotten: dict[str, int] = defaultdict(int)

    def note(self, topic: str, key: Hashable, row: object) -> None:
        """Notes that a row is new, or differs from before."""
        with self._lock:
            self.last += 1
            rows = self._rows[topic]
            rows.pop(key, None)
            rows[key] = self.last, row
            if len(rows) > self._kept:
                self._forgotten[topic], _ = rows.pop(next(iter(rows)))

    def miss(self, topic: str) -> None:
        """Notes that changes were lost: every reader has to read the whole list again."""
        with self._lock:
            self.last += 1
            self._forgotten[topic] = self.last

    def since(self, topic: str, number: int) -> tuple[list[Any], bool]:
        """Returns the rows changed after that number, and whether others are forgotten already."""
        with self._lock:
            rows = []
            for changed, row in reversed(self._rows[topic].values()):
                if changed <= number:
                    break
                rows.append(row)
            return rows[::-1], self._forgotten[topic] > number
