# SPDX-License-Identifier: Apache-2.0
"""What a browser takes of the machine, by /proc: all processes of its profile's folder."""

import os
from pathlib import Path


def processor_time(folder):
    """Seconds that the processes of the browser with this profile have used."""
    total = 0.0
    for process in _processes(folder):
        try:
            fields = (process / "stat").read_text().rpartition(")")[2].split()
            total += (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        except OSError:
            continue  # it has ended
    return total


def memory(folder):
    """Their memory [bytes], what they share divided among those that share it (PSS)."""
    total = 0
    for process in _processes(folder):
        try:
            lines = (process / "smaps_rollup").read_text().splitlines()
            total += next(int(line.split()[1]) for line in lines if line.startswith("Pss:")) * 1024
        except (OSError, StopIteration):
            continue  # it has ended
    return total


def _processes(folder):
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if folder in (process / "cmdline").read_text():
                yield process
        except OSError:
            continue  # it has ended
