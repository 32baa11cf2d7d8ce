# SPDX-License-Identifier: Apache-2.0
"""Notices for people about a shift: refused input, with the reason."""

import logging
from collections.abc import Callable, Iterator

MOST = 20
LOG = logging.getLogger(__name__)


class Notices:
    """Keeps the last MOST different sentences, the newest last; on_change() follows each change."""

    def __init__(self, on_change: Callable[[], object] | None = None) -> None:
        self._counts: dict[str, int] = {}
        self.on_change = on_change

    def __iter__(self) -> Iterator[str]:
        """Yields the sentences, with a count where one was added more than once."""
        for text, count in self._counts.items():
            yield text if count == 1 else f"{text} ({count} times)"

    def add(self, text: str) -> None:
        """Adds a sentence, or counts it again; logs a new one as a warning."""
        if text not in self._counts:
            LOG.warning(text)
        self._counts[text] = self._counts.pop(text, 0) + 1
        if len(self._counts) > MOST:
            del self._counts[next(iter(self._counts))]
        self._notify()

    def drop(self, text: str) -> None:
        """Removes a sentence that is no longer true."""
        if self._counts.pop(text, None):
            self._notify()

    def _notify(self) -> None:
        if self.on_change:
            self.on_change()
