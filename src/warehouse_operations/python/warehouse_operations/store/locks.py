# SPDX-License-Identifier: Apache-2.0
"""Locks by which one program at a time works on a file or folder, until its process ends."""

import contextlib
import fcntl
import os
import socket
import sys
import weakref
from datetime import datetime
from pathlib import Path
from typing import TextIO

SUFFIX = ".lock"
_HELD: "weakref.WeakSet[FileLock]" = weakref.WeakSet()


class InUseError(Exception):
    """Raised where another program holds the lock; names the program, its host and the time."""


class FileLock:
    """Locks a file or folder until release() or the end of this process.

    path: the file or folder to lock; the lock file is beside a file, or in a folder. The kernel
    holds the lock (flock): a lock file without a process locks nothing. Raises InUseError, OSError.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        path = Path(os.path.realpath(path))
        self._path = path / SUFFIX if path.is_dir() else path.with_name(path.name + SUFFIX)
        self._file: TextIO | None = None
        while not self._file:
            self._file = self._taken(path)
        _HELD.add(self)

    def _taken(self, path: Path) -> TextIO | None:
        """Returns the locked file, or None if its holder has just removed it."""
        # Readable by its owner alone: any reader could lock it.
        number = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o600)
        file = os.fdopen(number, "a+", encoding="utf-8", errors="replace")
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if not self._is_there(file):
                file.close()
                return None
            file.truncate(0)
            file.write(f"{holder()}, since {datetime.now():%Y-%m-%d %H:%M:%S}\n")
            file.flush()
        except BlockingIOError:
            file.seek(0)
            by = file.read(500).strip() or "another process"
            file.close()
            raise InUseError(f"{path}: is in use by {by}") from None
        except BaseException:
            file.close()
            raise
        return file

    def _is_there(self, file: TextIO) -> bool:
        with contextlib.suppress(FileNotFoundError):
            return os.path.samestat(os.fstat(file.fileno()), self._path.stat())
        return False

    def release(self) -> None:
        """Removes the lock, so that other programs can work on the path."""
        if self._file:
            self._path.unlink(missing_ok=True)
            self._file.close()
            self._file = None

    def leave_to_parent(self) -> None:
        """Drops the lock in a forked process; the parent keeps it."""
        if self._file:
            self._file.close()
            self._file = None

    def __enter__(self) -> "FileLock":
        return self

    def __exit__(self, *_: object) -> None:
        self.release()


def _forked() -> None:
    for held in list(_HELD):
        held.leave_to_parent()


os.register_at_fork(after_in_child=_forked)


def holder() -> str:
    """Returns the name, id and host of this process, for the messages of other programs."""
    program = Path(sys.argv[0] or "python").name
    return f"{program} (process {os.getpid()} on {socket.gethostname()})"
