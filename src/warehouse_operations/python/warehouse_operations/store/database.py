# SPDX-License-Identifier: Apache-2.0
"""The database of a warehouse: written by a thread of its own, read back after an interruption.

The changes between two commits of a journal are written together or not at all, and in order. A
transaction of the thread holds all commits that wait.
"""

import contextlib
import queue
import threading
from collections.abc import Iterator

from warehouse_operations.store.engines import (
    DatabaseError,
    lock,
    make_engine,
    open_engine,
    prepare,
    reason,
    shown,
)
from warehouse_operations.store.rows import Rows

__all__ = ["Database", "DatabaseError", "open_engine"]

WAITING = 20_000  # most commits that wait for the thread; the shift waits beyond it


class Database:
    """Takes Rows from any thread and writes them in order on its own; it locks out other programs.

    url: see engines.url_of. gather: longest time that rows wait to be written with others, which is
    cheaper [s]. Raises DatabaseError.
    """

    def __init__(self, url: str, gather: float = 0.0) -> None:
        self.url, self.engine = shown(url), make_engine(url)
        self._lock = contextlib.ExitStack()
        with self._lock as unless_ready:
            unless_ready.enter_context(lock(self.engine, url))
            prepare(self.engine, url)
            self._lock = unless_ready.pop_all()
        self._queue: queue.Queue[Rows | None] = queue.Queue(WAITING)
        self._gather, self._hurries = gather, threading.Event()
        self._error: Exception | None = None
        self._thread = threading.Thread(target=self._write, name="database", daemon=True)
        self._thread.start()

    def put(self, rows: Rows) -> None:
        """Queues Rows that belong together; raises DatabaseError if earlier ones could not be
        written."""
        self._check()
        self._queue.put(rows)

    def flush(self) -> None:
        """Waits until all rows are in the database; raises DatabaseError."""
        self._hurries.set()
        self._queue.join()
        self._hurries.clear()
        self._check()

    def close(self) -> None:
        """Flushes and closes; raises DatabaseError."""
        self._hurries.set()
        if self._thread.is_alive():
            self._queue.put(None)
            self._thread.join()
        self._lock.close()
        self.engine.dispose()
        self._check()

    def _check(self) -> None:
        if self._error:
            raise DatabaseError(f"{self.url}: {reason(self._error)}") from self._error

    @contextlib.contextmanager
    def reading(self) -> Iterator[None]:
        """Raises DatabaseError if the content of the database is invalid."""
        try:
            yield
        except DatabaseError:
            raise
        except Exception as error:  # a damaged file may raise any
            raise DatabaseError(
                f"{self.url}: its content can't be read: {reason(error)}; use another "
                "database, or with a copy of this one from before"
            ) from error

    def _write(self) -> None:
        ended = False
        while not ended:
            taken = [self._queue.get()]
            if self._gather:
                self._hurries.wait(self._gather)
            while not self._queue.empty():
                taken.append(self._queue.get())
            ended = None in taken
            rows = Rows()
            for rows_of_commit in taken:
                if rows_of_commit is not None:
                    rows.merge(rows_of_commit)
            try:
                if rows and not self._error:
                    with self.engine.begin() as connection:
                        rows.write(connection)
            except Exception as error:  # raised by the next put or flush
                self._error = error
            for _ in taken:
                self._queue.task_done()
