# SPDX-License-Identifier: Apache-2.0
"""Runs the programs that measure: ours, and those of other simulators."""

import json
import subprocess
import sys
from pathlib import Path

BENCH = Path(__file__).parent
BUILT = BENCH.parent / "build" / "bench"
VENV = BENCH.parent / ".venv"

# Simulated seconds of a chunk: less where a second takes a minute. Below 0.1 s no laser scans.
SHORT = {
    ("--robot jointed", 1000): 0.4,
    ("--hinges", 1000): 0.2,
    ("with_pybullet.py", 100): 0.4,
    ("with_pybullet.py", 1000): 0.1,
    ("with_mujoco.py", 1000): 0.2,
    ("bullet_bench", 10000): 0.2,
}


class FailedError(RuntimeError):
    """A program ended with an error; the message is its last line."""


def figures(command, **more):
    """The JSON objects that a command prints, each a dict to which `more` is added.

    The command's progress goes on to the terminal. Raises FailedError.
    """
    print(f"$ {' '.join(map(str, command))}", file=sys.stderr, flush=True)
    done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        raise FailedError(f"{Path(command[0]).name} ended with {done.returncode}")
    lines = (line for line in done.stdout.splitlines() if line.startswith("{"))
    out = [json.loads(line) | more for line in lines]
    for figure in out:
        print(f"  {figure}", file=sys.stderr, flush=True)
    return out


def sweep(program, options, fleets):
    """A program's figures for fleets of so many robots."""
    out = []
    for robots in fleets:
        keys = [key for key in SHORT if key[1] == robots]
        words = f"{program.name} {options}"
        seconds = next((SHORT[key] for key in keys if key[0] in words), 2)
        command = [program, *options.split(), "--seconds", seconds, robots]
        if program.suffix == ".py":
            command.insert(0, VENV / "bin" / "python")
        out += figures(command)
    return out


def install_peers():
    """Brings bench/requirements.txt into .venv; returns what could not be installed, with why."""
    if not (VENV / "bin" / "pip").exists():
        subprocess.run(
            ["/usr/bin/python3", "-m", "venv", "--system-site-packages", VENV], check=True
        )
        (VENV / "CATKIN_IGNORE").touch()
    missing = {}
    pip = [VENV / "bin" / "pip", "install", "-qq", "--disable-pip-version-check"]
    for line in (BENCH / "requirements.txt").read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        done = subprocess.run([*pip, line], stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode:
            missing[line.partition("==")[0]] = (done.stderr.strip() or "?").splitlines()[-1]
    return missing
