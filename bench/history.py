# SPDX-License-Identifier: Apache-2.0
"""What was measured at each commit: history.jsonl, a line a run.

A line: {"commit", "time" (of the run), "load" (of the machine before it, programs that wanted a
core), "cores", "parts": {part: [figure, ...]}}, a figure being the members of figures.Figure that
are not empty. Lines from before the history began have "note" instead of a load.
"""

import dataclasses
import datetime
import json
import os
import subprocess

from figures import Figure
from programs import BENCH

FILE = BENCH / "history.jsonl"


class History:
    """The lines of a file; none where there is no file."""

    def __init__(self, path=FILE):
        self._path = path
        self.lines = [json.loads(line) for line in _lines(path)]

    def newest(self, part):
        """{name: (figure, line)} of the newest line that has that figure, in the order of names in
        the newest line that has the part."""
        out = {}
        for line in reversed(self.lines):
            for members in line["parts"].get(part, []):
                figure = Figure(**members)
                out.setdefault(figure.name, (figure, line))
        return out

    def append(self, parts, load):
        """Adds what a run measured: {part: [Figure, ...]}."""
        if not parts:
            return
        line = {"commit": commit(), "time": now(), "load": load, "cores": os.cpu_count()}
        line["parts"] = {
            part: [_members(f) for f in measurements] for part, measurements in parts.items()
        }
        self.lines.append(line)
        with self._path.open("a") as file:
            file.write(json.dumps(line) + "\n")


def commit():
    """That is checked out; `+` marks changes that it doesn't have."""
    changed = _git("status", "--porcelain", "--", ".", ":!bench/history.jsonl", ":!bench/README.md")
    return _git("rev-parse", "--short", "HEAD") + ("+" if changed else "")


def now():
    return datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")


def _lines(path):
    return path.read_text().splitlines() if path.exists() else []


def _members(figure):
    """Returns the fields that are not empty, with the digits that are significant."""
    default = Figure("", 0)
    out = {}
    for field in dataclasses.fields(figure):
        value = getattr(figure, field.name)
        if value != getattr(default, field.name) or field.name in ("name", "value"):
            out[field.name] = float(f"{value:.4g}") if isinstance(value, float) else value
    return out


def _git(*words):
    command = ["git", "-C", str(BENCH.parent), *words]
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.strip()
