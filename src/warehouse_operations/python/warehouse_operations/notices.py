# SPDX-License-Identifier: Apache-2.0
"""What a person is to know of a shift and nothing else tells: what it could not take, and why."""

import logging

MOST = 20
LOG = logging.getLogger(__name__)


class Notices:
    """The last MOST different sentences, the newest last; on_change() is called after a change."""

    def __init__(self, on_change=None):
        self._counts = {}
        self.on_change = on_change

    def __iter__(self):
        """Sentences; those that were told more than once say how often."""
        for text, count in self._counts.items():
            yield text if count == 1 else f"{text} ({count} times)"

    def add(self, text):
        if text not in self._counts:
            LOG.warning(text)
        self._counts[text] = self._counts.pop(text, 0) + 1
        if len(self._counts) > MOST:
            del self._counts[next(iter(self._counts))]
        self._tell()

    def drop(self, text):
        """It does not hold any more."""
        if self._counts.pop(text, None):
            self._tell()

    def _tell(self):
        if self.on_change:
            self.on_change()
