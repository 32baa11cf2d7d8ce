# SPDX-License-Identifier: Apache-2.0
"""Free memory of this process, which the heap keeps, and the system gets back."""

import ctypes
import threading
import time
from collections.abc import Callable

PERIOD = 60.0  # from one return to the next [s, wall]


def trim() -> Callable[[int], int] | None:
    """Returns the C library's malloc_trim; None if it has none: glibc alone does."""
    return getattr(ctypes.CDLL(None), "malloc_trim", None)


def keep_trimmed(period: float = PERIOD) -> None:
    """Has a thread return free memory to the system, for as long as the process lives.

    The heap itself gives back only what is free at its end. Messages that come and go leave gaps
    below what stays: in a long shift, 4 to 10 MB of each node. A return takes some milliseconds.
    """
    if give_back := trim():
        threading.Thread(target=_trim_forever, args=(give_back, period), daemon=True).start()


def _trim_forever(give_back: Callable[[int], int], period: float) -> None:
    while True:
        time.sleep(period)
        give_back(0)
