# SPDX-License-Identifier: Apache-2.0
"""The states of robots and stations over the last hour, for readers that ask what is new.

As bytes, little endian: a uint32, how long the head is; the head in JSON, filled up with spaces to
whole words; of each moment with changes its time after `origin` [s] as float32, then how many
changes it has as uint32; then all changes as uint32, the row times 8 plus the state.

The head has `epoch`, `last` (to be sent as `since` next time), `is_whole`, `origin`, `begin` (since
when states are known), `now`, the `rows` that the reader does not know yet, each [kind, name],
`base`, the state of each row before the first change if it is all that is kept, and `moments`.
"""

from collections import deque
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from warehouse_viewer.json_text import dumps

HOUR = 3600.0  # that is kept [s, simulated]
MOST_CHANGES = 1_000_000  # that are kept, at four bytes each
GONE = 7  # the state of an unknown row
STATES = 8  # of three bits

Row = tuple[str, str]  # ("robot" or "station", its name)


class Moment(NamedTuple):
    """What changed at a time [s]: rows (n,) uint32 and their states (n,) uint8."""

    number: int
    time: float
    rows: np.ndarray
    states: np.ndarray


class _Group(NamedTuple):
    """Rows of a kind: those that are there now, and every one that ever was."""

    names: tuple[str, ...]
    rows: np.ndarray
    every: np.ndarray


class SpanLog:
    """Keeps an hour of states, or as much of it as `most` changes are. One thread at a time."""

    def __init__(self, span: float = HOUR, most: int = MOST_CHANGES) -> None:
        self._span, self._most = span, most
        self.epoch = 0
        self._forget(0.0)

    def _forget(self, now: float) -> None:
        """Begins again: another world, or a time before the last one."""
        self.epoch += 1
        self.origin = self.begin = self.now = now
        self.last, self._count = 0, 0
        self.rows: list[Row] = []
        self._index: dict[Row, int] = {}
        self._groups: dict[str, _Group] = {}
        self._state = np.zeros(0, np.uint8)
        self._base = np.zeros(0, np.uint8)
        self._moments: deque[Moment] = deque()

    def update(self, now: float, kind: str, names: Sequence[str], states: np.ndarray) -> None:
        """Updates from the states, (n,) below GONE, of all rows of a kind at `now` [s]."""
        if now < self.now or not self.rows:
            self._forget(now)
        self.now = now
        rows = self._rows_of(kind, names)
        after = self._state.copy()
        after[self._groups[kind].every] = GONE
        after[rows] = states
        changed = np.flatnonzero(after != self._state).astype(np.uint32)
        if len(changed):
            self._add(Moment(self.last + 1, now, changed, after[changed]))
        self._trim()

    def _rows_of(self, kind: str, names: Sequence[str]) -> np.ndarray:
        """Returns the numbers of the rows of these names; new ones are added."""
        group, members = self._groups.get(kind), tuple(names)
        if group and group.names == members:
            return group.rows
        for name in members:
            if (kind, name) not in self._index:
                self._index[kind, name] = len(self.rows)
                self.rows.append((kind, name))
        new = np.full(len(self.rows) - len(self._state), GONE, np.uint8)
        self._state = np.concatenate((self._state, new))
        self._base = np.concatenate((self._base, new))
        rows = np.array([self._index[kind, name] for name in members], np.int64)
        every = np.array([i for i, row in enumerate(self.rows) if row[0] == kind], np.int64)
        self._groups[kind] = _Group(members, rows, every)
        return rows

    def _add(self, moment: Moment) -> None:
        self._state[moment.rows] = moment.states
        self._moments.append(moment)
        self.last, self._count = moment.number, self._count + len(moment.rows)

    def _trim(self) -> None:
        """Moves what is older than the span, or too much, into the states before."""
        self.begin = max(self.begin, self.now - self._span)
        while self._moments and (self._moments[0].time < self.begin or self._count > self._most):
            gone = self._moments.popleft()
            self._base[gone.rows] = gone.states
            self._count -= len(gone.rows)
            self.begin = max(self.begin, gone.time)

    def encode(self, epoch: int = 0, since: int = 0, known: int = 0) -> bytes:
        """Returns what is new to a reader that has read up to the moment `since` of an `epoch`, and
        knows that many rows; all that is kept if that is no longer known."""
        first = self._moments[0].number if self._moments else self.last + 1
        is_whole = epoch != self.epoch or not first - 1 <= since <= self.last or not known
        moments = [moment for moment in self._moments if is_whole or moment.number > since]
        head = {
            "epoch": self.epoch,
            "last": self.last,
            "is_whole": is_whole,
            "origin": self.origin,
            "begin": round(self.begin, 3),
            "now": round(self.now, 3),
            "rows": self.rows[0 if is_whole else known :],
            "base": self._base.tolist() if is_whole else [],
            "moments": len(moments),
        }
        return _packed(head, moments, self.origin)


def _packed(head: dict[str, Any], moments: Sequence[Moment], origin: float) -> bytes:
    text = dumps(head).encode()
    text += b" " * (-len(text) % 4)
    times = np.array([moment.time - origin for moment in moments], "<f4")
    counts = np.array([len(moment.rows) for moment in moments], "<u4")
    changes = [moment.rows * np.uint32(STATES) + moment.states for moment in moments]
    joined = np.concatenate(changes).astype("<u4") if changes else np.zeros(0, "<u4")
    parts = (np.uint32(len(text)).tobytes(), text, times, counts, joined)
    return b"".join(bytes(part) for part in parts)
