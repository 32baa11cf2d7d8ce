# SPDX-License-Identifier: Apache-2.0
"""Who works on a file or a folder: one program at a time, until it ends, however it ends."""

import contextlib
import fcntl
import os
import socket
import sys
import weakref
from datetime import datetime
from pathlib import Path

SUFFIX = ".lock"
_HELD: weakref.WeakSet = weakref.WeakSet()


class InUseError(Exception):
    """Another program works on it; the text says which, where and since when."""


class FileLock:
    """Held for as long as this process lives or until release(); raises InUseError, OSError.

    It is the kernel's lock (flock) on a file of its own; that file alone, without a lock on it,
    means nothing. path: what is locked; the lock file is beside it, or in it if it is a folder.
    """

    def __init__(self, path):
        path = Path(os.path.realpath(path))
        self._path = path / SUFFIX if path.is_dir() else path.with_name(path.name + SUFFIX)
        self._file = None
        while not self._file:
            self._file = self._taken(path)
        _HELD.add(self)

    def _taken(self, path):
        """The lock file, or None if its holder has just removed it."""
        file = self._path.open("a+", encoding="utf-8", errors="replace")
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

    def _is_there(self, file):
        with contextlib.suppress(FileNotFoundError):
            return os.path.samestat(os.fstat(file.fileno()), self._path.stat())
        return False

    def release(self):
        """Lets others work on it."""
        if self._file:
            self._path.unlink(missing_ok=True)
            self._file.close()
            self._file = None

    def leave_to_parent(self):
        """In a process that was forked: it holds nothing, and keeps nothing held."""
        if self._file:
            self._file.close()
            self._file = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.release()


def _forked():
    for one in list(_HELD):
        one.leave_to_parent()


os.register_at_fork(after_in_child=_forked)


def holder():
    """This process, as others are told of it."""
    program = Path(sys.argv[0] or "python").name
    return f"{program} (process {os.getpid()} on {socket.gethostname()})"
