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


# Of one program [s, wall]. None takes a third of it on a quiet machine; a crowded one is slower by
# as much as it has programs.
PATIENCE = 900


class FailedError(RuntimeError):
    """A program ended with an error; the message is its last line."""


def say(text):
    """How far it is, for who waits; the figures themselves go to standard output."""
    print(text, file=sys.stderr, flush=True)


def figures(command, patience=PATIENCE):
    """The JSON objects that a command prints, each a dict.

    The command's progress goes on to the terminal. Raises FailedError, also where it takes longer
    than `patience` [s] and is ended.
    """
    words = list(map(str, command))
    say(f"$ {' '.join(words)}")
    try:
        done = subprocess.run(
            words, stdout=subprocess.PIPE, text=True, check=False, timeout=patience
        )
    except subprocess.TimeoutExpired as error:
        name = Path(command[0]).name
        raise FailedError(f"{name} was ended, not being done after {patience:g} s") from error
    if done.returncode:
        raise FailedError(f"{Path(command[0]).name} ended with {done.returncode}")
    out = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    for figure in out:
        say(f"  {figure}")
    return out


def sweep(program, options, fleets, seconds=2):
    """A program's figures for fleets of so many robots, in chunks of simulated time [s]."""
    out = []
    for robots in fleets:
        keys = [key for key in SHORT if key[1] == robots]
        words = f"{program.name} {options}"
        chunk = min(seconds, next((SHORT[key] for key in keys if key[0] in words), seconds))
        command = [program, *options.split(), "--seconds", chunk, robots]
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
