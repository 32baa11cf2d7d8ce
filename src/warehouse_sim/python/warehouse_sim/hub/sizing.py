# SPDX-License-Identifier: Apache-2.0
"""One sizing of a warehouse: the program `size` in a folder, which keeps its answer."""

import json
import math
import os
import signal
import subprocess
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from warehouse_sim.hub import wish
from warehouse_sim.hub.wish import WishError

FILE, SAID, PROGRESS, REPORT = "sizing.json", "said.txt", "progress.txt", "report.html"
MOST_RATE, MOST_HOURS = 1e6, 24.0
IMPOSSIBLE = 2  # exit code of `size`: no number of robots and stations suffices
PATIENCE = 5.0  # between the request to end and the kill [s, wall]


@dataclass(frozen=True)
class Question:
    """What a sizing is asked. layout: a preset, or a layout file; late: share of orders that may
    be; hours: of a shift; realism: of the robots' batteries and failures."""

    layout: str
    orders_per_hour: float
    late: float = 0.01
    hours: float = 8.0
    realism: str = ""

    def words(self, folder: Path) -> list[str]:
        """Returns the arguments of `size`, which writes into `folder`."""
        asked = {key.replace("_", "-"): value for key, value in asdict(self).items() if value}
        processes = max((os.cpu_count() or 2) - 1, 1)
        out = {**asked, "processes": processes, "out": folder}
        return [f"--{key}={value}" for key, value in out.items()]


def read(body: Mapping[str, Any], folder: Path) -> Question:
    """Returns the question of a request: `size`, a preset, or `layout`, a file or its text, which
    becomes a file of `folder`. Raises WishError."""
    fields = ("size", "layout", "orders_per_hour", "late", "hours", "realism")
    if unknown := sorted(body.keys() - {*fields}):
        raise WishError(unknown[0][:100], f"{', '.join(fields)} were expected")
    if ("size" in body) == ("layout" in body):
        raise WishError("size", "size, a preset, or layout was expected")
    rate = _number(body, "orders_per_hour", MOST_RATE, None)
    late, hours = _number(body, "late", 1.0, 0.01), _number(body, "hours", MOST_HOURS, 8.0)
    chosen = {key: body[key] for key in ("size", "layout", "realism") if key in body}
    asked = wish.read({"name": "sizing", **chosen}, folder)
    if asked.arguments.get("size") == "empty":
        raise WishError("size", "a warehouse was expected, not an empty world")
    known = wish.written(asked, folder).arguments
    layout = known.get("layout") or known["size"]
    return Question(layout, rate, late, hours, known.get("realism", ""))


def _number(body: Mapping[str, Any], key: str, most: float, default: float | None) -> float:
    value = body.get(key, default)
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if not is_number or not math.isfinite(value) or not 0 < value <= most:
        raise WishError(key, f"a number above 0, up to {most:g}, was expected")
    return float(value)


class Sizing:
    """A sizing in a folder whose name is its number. Methods block."""

    def __init__(self, folder: Path, question: Question) -> None:
        self.folder, self.question = folder, question
        self._process: subprocess.Popen | None = None
        self._code: int | None = None
        self._began = time.monotonic()

    @classmethod
    def kept(cls, folder: Path) -> "Sizing":
        """Returns the sizing that a folder keeps. Raises OSError, ValueError."""
        data = json.loads((folder / FILE).read_text(encoding="utf-8"))
        try:
            out = cls(folder, Question(**data["question"]))
        except (TypeError, KeyError) as error:
            raise ValueError(f"not a sizing: {error}") from error
        out._code = data["code"]
        return out

    @property
    def lives(self) -> bool:
        """Whether its program runs."""
        return self._process is not None and self._process.poll() is None

    def start(self, environment: Mapping[str, str]) -> None:
        """Starts its program. Raises OSError."""
        self._write()
        words = ["rosrun", "warehouse_operations", "size", *self.question.words(self.folder)]
        with (self.folder / SAID).open("wb") as said, (self.folder / PROGRESS).open("wb") as shown:
            self._process = subprocess.Popen(
                ["setpriv", "--pdeathsig", "TERM", "nice", "-n", "10", *words],
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=shown,
                env=dict(environment),
                start_new_session=True,
            )

    def end(self) -> None:
        """Ends its program with the processes that it has."""
        if self._process is None:
            return
        for number in (signal.SIGINT, signal.SIGKILL):
            with suppress(ProcessLookupError):
                os.killpg(self._process.pid, number)
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(PATIENCE)
        self._note_end()

    def _note_end(self) -> None:
        if self._process and self._code is None:
            self._code = self._process.poll()
            with suppress(OSError):
                self._write()

    def _write(self) -> None:
        data = {"question": asdict(self.question), "code": self._code}
        (self.folder / FILE).write_text(json.dumps(data, indent=1), encoding="utf-8")

    def row(self) -> dict[str, Any]:
        """Returns the sizing as the API lists it."""
        lives = self.lives
        if not lives:
            self._note_end()
        has_report = (self.folder / REPORT).is_file()
        return {
            "id": int(self.folder.name),
            "state": "RUNNING" if lives else self._state(),
            "question": asdict(self.question),
            "seconds": round(time.monotonic() - self._began, 1) if lives else 0.0,
            "progress": _last_line(self.folder / PROGRESS) if lives else "",
            "answer": "" if lives else self._answer(),
            "url": f"/api/v1/sizings/{self.folder.name}/{REPORT}" if has_report else "",
        }

    def _state(self) -> str:
        states = {0: "DONE", IMPOSSIBLE: "IMPOSSIBLE"}
        if self._code in states:
            return states[self._code]
        return "FAILED" if self._code == 1 else "STOPPED"

    def _answer(self) -> str:
        """Returns what the program said below its table, or why it has no answer."""
        said = _text(self.folder / SAID).strip()
        sentences = said.partition("\n\n")[2].rpartition("\n\n")[0]
        return sentences or _last_line(self.folder / PROGRESS).removeprefix("size: ")


def _text(path: Path) -> str:
    with suppress(OSError):
        return path.read_text(encoding="utf-8", errors="replace")
    return ""


def _last_line(path: Path) -> str:
    return (_text(path).strip().splitlines() or [""])[-1]
