# SPDX-License-Identifier: Apache-2.0
"""The process of runs: reads Tasks, then which of them to run with which number,
and answers each with its Outcome.

Messages on both pipes are a length of four bytes and a pickle. The process takes what processor
time others leave, has a bound on its memory, and ends with its parent.
"""

import contextlib
import ctypes
import logging
import os
import pickle
import resource
import signal
import struct
import sys
from typing import IO, Any

LENGTH = struct.Struct("<I")
PR_SET_PDEATHSIG = 1
LOWEST = 19  # of nice


def send(stream: IO[bytes], message: Any) -> None:
    """Writes a message. Raises OSError where the pipe has no reader."""
    content = message if isinstance(message, bytes) else pickle.dumps(message, 5)
    stream.write(LENGTH.pack(len(content)) + content)
    stream.flush()


def receive(stream: IO[bytes]) -> Any:
    """Reads a message. Raises EOFError at the end of the stream."""
    head = stream.read(LENGTH.size)
    if len(head) < LENGTH.size:
        raise EOFError
    content = stream.read(LENGTH.unpack(head)[0])
    return pickle.loads(content)  # of the parent, through a pipe of its own


def main() -> None:
    """Serves runs until the parent closes the pipe."""
    _be_modest(int(sys.argv[1]))
    out = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what else is printed is no answer
    logging.disable()  # what orders a run refuses is no news
    source = sys.stdin.buffer
    from warehouse_operations.forecast import ahead, pacing

    with contextlib.suppress(EOFError, BrokenPipeError):
        tasks = pacing.paced(receive(source))
        while True:
            index, number = receive(source)
            try:
                answer: Any = ahead.run(tasks[index], number)
            except MemoryError:
                answer = "it needs more memory than a run may have"
            except Exception as error:  # the parent says it
                answer = f"{type(error).__name__}: {error}"
            send(out, answer)


def _be_modest(memory: int) -> None:
    """Takes the lowest priority, and at most so much memory [bytes]."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent ends it
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    os.nice(LOWEST)
    with contextlib.suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))
    resource.setrlimit(resource.RLIMIT_DATA, (memory, memory))


if __name__ == "__main__":
    main()
