# SPDX-License-Identifier: Apache-2.0
"""Files that a user names: regular ones alone, and none larger than its reader takes.

A device never ends, and a pipe that no program writes never begins: neither is read. Everything
that reads such a file opens it here, or has it checked where a library opens it by its path.
"""

import errno
import os
import stat
import xml.etree.ElementTree as ElementTree
from typing import BinaryIO

PathName = str | os.PathLike[str]

MOST_BYTES = 300_000_000  # of a text, a world or a picture
KINDS = {stat.S_IFIFO: "a pipe", stat.S_IFCHR: "a device", stat.S_IFBLK: "a device"}


def opened(path: PathName, most: int | None = MOST_BYTES) -> BinaryIO:
    """Opens a regular file of up to `most` bytes (None: any size) to be read. Raises OSError."""
    # Without this flag it would wait for the writer of a pipe.
    file = os.fdopen(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC), "rb")
    try:
        _check(os.fstat(file.fileno()), path, most)
    except OSError:
        file.close()
        raise
    return file


def check(path: PathName, most: int | None = None) -> None:
    """Raises OSError unless a path leads to what opened() opens."""
    opened(path, most).close()


def read_bytes(path: PathName, most: int = MOST_BYTES) -> bytes:
    """Returns the content of a file. Raises OSError."""
    with opened(path, most) as file:
        return file.read(most)


def read_text(path: PathName, encoding: str = "utf-8", most: int = MOST_BYTES) -> str:
    """Returns the text of a file. Raises OSError, UnicodeDecodeError."""
    return read_bytes(path, most).decode(encoding).replace("\r\n", "\n").replace("\r", "\n")


def read_xml(path: PathName, most: int = MOST_BYTES) -> ElementTree.Element:
    """Returns the root of an XML file. Raises OSError, ElementTree.ParseError, LookupError."""
    with opened(path, most) as file:
        return ElementTree.parse(file).getroot()


def _check(status: os.stat_result, path: PathName, most: int | None) -> None:
    if stat.S_ISDIR(status.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(status.st_mode):
        kind = KINDS.get(stat.S_IFMT(status.st_mode), "no regular file")
        raise OSError(errno.EINVAL, f"is {kind}; a regular file was expected", str(path))
    if most is not None and status.st_size > most:
        size = f"has {status.st_size / 1e6:.0f} MB; {most / 1e6:.0f} MB at most were expected"
        raise OSError(errno.EFBIG, size, str(path))
