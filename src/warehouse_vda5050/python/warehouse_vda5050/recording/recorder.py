# SPDX-License-Identifier: Apache-2.0
"""Takes what goes through a broker: judges it, writes it, and counts."""

import threading
import time
from collections import Counter
from collections.abc import Iterator
from queue import Empty, SimpleQueue

from warehouse_vda5050.recording.entry import Entry
from warehouse_vda5050.recording.file import Writer
from warehouse_vda5050.schemas import why_invalid
from warehouse_vda5050.topics import TopicError, Topics

BEHIND = 5000  # messages that wait, from which on none is checked
FLUSH = 1.0  # between two writes to the disk [s]
MOST_REASONS = 10  # in a summary


class Recorder:
    """take() may be called as fast as messages come; a thread checks and writes them.

    `fault` is why nothing is written any more, '' if all is well.
    """

    def __init__(self, writer: Writer, topics: Topics) -> None:
        self._writer, self._topics = writer, topics
        self._queue: SimpleQueue[Entry] = SimpleQueue()
        self._ended = threading.Event()
        self.fault = ""
        self.taken = 0  # count of messages
        self.counts: Counter[str] = Counter()  # messages by kind
        self.reasons: Counter[str] = Counter()  # of invalid ones
        self.unchecked = 0
        self._first = self._last = 0.0
        self._thread = threading.Thread(target=self._run, name="record", daemon=True)
        self._thread.start()

    def take(self, topic: str, payload: bytes, qos: int, retain: bool) -> None:
        """Takes a message that has just arrived."""
        self.taken += 1
        self._queue.put(Entry(time.time(), topic, payload, qos, retain))

    def _run(self) -> None:
        try:
            while not (self._ended.is_set() and self._queue.empty()):
                self._write_some()
                self._writer.flush()
        except OSError as error:
            self.fault = str(error)

    def _write_some(self) -> None:
        end = time.monotonic() + FLUSH
        while time.monotonic() < end:
            try:
                self._write(self._queue.get(timeout=0.1))
            except Empty:
                if self._ended.is_set():
                    return

    def _write(self, entry: Entry) -> None:
        is_behind = self._queue.qsize() > BEHIND
        kind, why = self._judged(entry, is_behind)
        self.counts[kind] += 1
        self.unchecked += is_behind
        if why:
            self.reasons[f"{kind}: {why}"] += 1
        self._first, self._last = self._first or entry.time, entry.time
        valid = None if is_behind else not why
        self._writer.write(
            Entry(entry.time, entry.topic, entry.payload, entry.qos, entry.retain, valid, why)
        )

    def _judged(self, entry: Entry, is_behind: bool) -> tuple[str, str]:
        """Returns the kind of a message, and why it is not valid or ''."""
        try:
            _, kind = self._topics.parse(entry.topic)
        except TopicError as error:
            return "other topics", "" if is_behind else str(error)
        return kind.value, "" if is_behind else why_invalid(kind, entry.payload)

    @property
    def total(self) -> int:
        """The count of messages that were written."""
        return self.counts.total()

    @property
    def invalid(self) -> int:
        """The count of those that are not valid."""
        return self.reasons.total()

    def close(self) -> int:
        """Writes what waits, and ends the file; returns its size in bytes. Raises OSError."""
        self._ended.set()
        self._thread.join()
        if self.fault:
            raise OSError(self.fault)
        return self._writer.close()

    def summary(self) -> Iterator[str]:
        """Yields what was recorded, a line each."""
        span = self._last - self._first
        yield f"{self.total} messages in {span:.1f} s, {self.invalid} of them not valid"
        yield from (f"{count:8} {kind}" for kind, count in self.counts.most_common())
        for reason, count in self.reasons.most_common(MOST_REASONS):
            yield f"{count:8} not valid: {reason}"
        left = len(self.reasons) - MOST_REASONS
        if left > 0:
            yield f"         and {left} other reasons"
        if self.unchecked:
            yield f"{self.unchecked:8} not checked: they came faster than they can be"
