# SPDX-License-Identifier: Apache-2.0
"""Simulates one run of a scenario: `python3 -m warehouse_viewer.whatif.run SCENARIO.yaml SEED`; or
searches a layout, for a DESIGN.yaml.

A process of its own, which leaves the machine to others and ends with the server that started it:
as soon as its input is closed, whatever closed it. Prints progress as `simulate --progress json`
does, a search {time, of, stage}, and as the last line {done: [faults]} or {error}.
"""

import multiprocessing
import os
import signal
import sys
import threading
from pathlib import Path
from types import FrameType

from warehouse_layout.file.layout_file import LayoutFileError
from warehouse_operations.design import packages
from warehouse_operations.reports import report
from warehouse_operations.runs import executors, sweep
from warehouse_operations.runs.progress import ProgressLines
from warehouse_operations.runs.simulation import ERRORS, simulate
from warehouse_viewer.json_text import dumps
from warehouse_viewer.whatif import design_settings
from warehouse_viewer.whatif.design_settings import DesignSettings
from warehouse_viewer.whatif.designs import write_answer
from warehouse_viewer.whatif.queue import processors
from warehouse_viewer.whatif.scenario import ScenarioError

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


def designed(file: Path) -> list[str]:
    """Searches the layout of a design.yaml, on as many processors as the queue has, and writes its
    folder; returns no faults. Raises ScenarioError."""
    from warehouse_operations.design.task import ERRORS as WRONG  # noqa: PLC0415 (takes long)

    packages.use_environments()
    signal.signal(signal.SIGTERM, _end_with_processes)
    folder = file.parent
    kept = folder.parent.parent
    task = DesignSettings.read(folder).task(kept, folder / design_settings.COSTS)
    try:
        answer = task.run(folder, executors.make(processors()), on_shift=_show)
    except WRONG as error:
        raise ScenarioError(str(error)) from error
    write_answer(folder, answer)
    return []


def _show(share: float, stage: str) -> None:
    print(dumps({"time": share, "of": 1.0, "stage": stage}), flush=True)


def _end_with_processes(_: int, __: FrameType | None) -> None:
    """Ends a search that is cancelled, by which its executor ends its processes."""
    sys.exit(ENDED)


def end_with_server() -> None:
    """Ends this process, and its own, as soon as its input ends."""

    def wait() -> None:
        # Without sys.stdin, whose lock a process that is forked meanwhile would wait for.
        while os.read(0, 1 << 16):
            pass
        for process in multiprocessing.active_children():
            process.kill()
        os._exit(ENDED)

    threading.Thread(target=wait, daemon=True).start()


def main() -> None:
    """Runs what the arguments name."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in a terminal is meant for the server
    os.nice(NICE)
    end_with_server()
    file, seed = Path(sys.argv[1]), int(sys.argv[2])
    try:
        is_design = file.name == design_settings.FILE
        result = {"done": designed(file) if is_design else simulated(file, seed)}
    except (*ERRORS, LayoutFileError, sweep.SweepError, ScenarioError, OSError) as error:
        print(dumps({"error": str(error)}), flush=True)
        sys.exit(1)
    print(dumps(result), flush=True)


if __name__ == "__main__":
    main()
