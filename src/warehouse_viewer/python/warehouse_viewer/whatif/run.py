# SPDX-License-Identifier: Apache-2.0
"""Simulates one run of a scenario: `python3 -m warehouse_viewer.whatif.run SCENARIO.yaml SEED`.

A process of its own, which leaves the machine to others and ends with the server that started it:
as soon as its input is closed, whatever closed it. Prints progress as `simulate --progress json`
does, and as the last line {done: [faults]} or {error}.
"""

import os
import signal
import sys
import threading
from pathlib import Path

from warehouse_layout.file.layout_file import LayoutFileError
from warehouse_operations.reports import report
from warehouse_operations.runs import sweep
from warehouse_operations.runs.progress import ProgressLines
from warehouse_operations.runs.simulation import ERRORS, simulate
from warehouse_viewer.json_text import dumps

NICE = 10
ENDED = 3  # the exit code where the server is gone


def simulated(file: Path, seed: int) -> list[str]:
    """Simulates the run and writes its folder; returns its faults, sentences."""
    jobs = {
        description.seed: (description, folder) for description, folder in sweep.read(file).jobs
    }
    description, folder = jobs[seed]
    progress = ProgressLines(description.seconds, sys.stdout)
    return simulate(description, folder, progress=progress, write_report=report.write)[1]


def end_with_server() -> None:
    """Ends this process as soon as its input ends."""

    def wait() -> None:
        sys.stdin.buffer.read()
        os._exit(ENDED)

    threading.Thread(target=wait, daemon=True).start()


def main() -> None:
    """Runs what the arguments name."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in a terminal is meant for the server
    os.nice(NICE)
    end_with_server()
    try:
        result = {"done": simulated(Path(sys.argv[1]), int(sys.argv[2]))}
    except (*ERRORS, LayoutFileError, sweep.SweepError, OSError) as error:
        print(dumps({"error": str(error)}), flush=True)
        sys.exit(1)
    print(dumps(result), flush=True)


if __name__ == "__main__":
    main()
