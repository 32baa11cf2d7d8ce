# SPDX-License-Identifier: Apache-2.0
"""Searches for layouts in a folder: their settings, their runs in the queue, and their fronts."""

import contextlib
import csv
import functools
import json
import os
import shutil
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from warehouse_layout.drawing import draw
from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import SUFFIX
from warehouse_operations.design import packages
from warehouse_viewer.json_text import dumps
from warehouse_viewer.whatif import design_settings, shown
from warehouse_viewer.whatif.design_settings import COSTS, FILE, DesignError, DesignSettings
from warehouse_viewer.whatif.queue import Active, Job, Outcome, Queue
from warehouse_viewer.whatif.scenario import DESIGNS, ScenarioError, checked_name, is_file_name
from warehouse_viewer.whatif.stored import States

if TYPE_CHECKING:
    from warehouse_operations.design.task import Answer

ANSWER = "answer.json"  # what the search found, in sentences; there once it is over
FRONT, REPORT = "front.csv", "report.html"
MOST_DESIGNS = 100
RUN = 0  # a search is one job, its own
BEGUN = 0.05  # share of a search from which its own pace gives its duration
# Columns of the front that the page shows: their key, and the heading in FRONT.
COLUMNS = {
    "to_buy": "to buy",
    "a_piece": "cost a piece",
    "late": "late %",
    "robots": "robots",
    "stations": "stations",
    "replenishing": "replenishing",
    "units": "units",
    "contacts": "contacts",
    "unseen_a_piece": "unseen cost a piece",
    "unseen_a_piece_half": "± cost",
    "unseen_late": "unseen late %",
    "unseen_late_half": "± late %",
}

Json = dict[str, Any]


class Designs:
    """The searches of a Workshop's folder `kept`, a folder each."""

    def __init__(self, kept: Path, queue: Queue) -> None:
        self._kept, self._queue = kept, queue
        self._path = kept / DESIGNS

    @staticmethod
    def owns(job: Job) -> bool:
        """Returns whether a job of the queue is a search."""
        return job.file.name == FILE

    def all(self) -> list[Json]:
        """Returns all searches as the page shows them."""
        active = {process.job: process for process in self._queue.active()}
        waiting = set(self._queue.waiting())
        return [self._shown(name, active, waiting) for name in self.names()]

    def names(self) -> list[str]:
        """Returns the names of all searches."""
        names = (file.parent.name for file in self._path.glob(f"*/{FILE}"))
        return sorted((name for name in names if not name.startswith(".")), key=str.casefold)

    def note_cut(self) -> None:
        """Notes the searches that were under way or waited when the server ended."""
        for name in self.names():
            states = States(self._path / name)
            if states.read().get(str(RUN), {}).get("state") in ("waits", "runs"):
                states.put([RUN], shown.CUT)

    def estimate(self, settings: object) -> Json:
        """Returns how long a search takes [s of a core], about. Raises DesignError."""
        chosen = DesignSettings.of_json(settings)
        design_settings.checked(chosen, self._kept, self._kept / COSTS)
        return {"seconds": 3600 * chosen.cpu_hours, "processes": self._queue.processes}

    def create(self, name: str, settings: object) -> Json:
        """Makes a search with the folder's costs as they are now. Raises DesignError."""
        chosen = DesignSettings.of_json(settings)
        design_settings.checked(chosen, self._kept, self._kept / COSTS)
        name = _named(name)
        if len(self.names()) >= MOST_DESIGNS:
            raise DesignError("", f"there are {MOST_DESIGNS} searches; delete some first")
        if (self._path / name).exists():
            raise DesignError("name", f"'{name}' is there already; another name was expected")
        self._path.mkdir(exist_ok=True)
        with tempfile.TemporaryDirectory(
            prefix=".draft-", dir=self._path, ignore_cleanup_errors=True
        ) as made:
            draft = Path(made, "design")
            draft.mkdir()
            chosen.write(draft)
            shutil.copyfile(self._kept / COSTS, draft / COSTS)
            draft.rename(self._path / name)
        return {"name": name}

    def run(self, name: str) -> Json:
        """Begins a search, or goes on with it. Raises DesignError without Optuna, QueueError."""
        folder = self._of(name)
        if lack := packages.lack_of_optuna("whatif"):
            raise DesignError("", lack)
        design_settings.checked(DesignSettings.read(folder), self._kept, folder / COSTS)
        if _answer(folder):
            return {"runs": 0}
        self._queue.add([_job(name, folder)])
        States(folder).put([RUN], "waits")
        return {"runs": 1}

    def cancel(self, name: str) -> Json:
        """Ends a search that waits or runs; its shifts stay, and it can go on."""
        self._queue.cancel(_job(name, self._of(name)).scenario)
        return {"name": name}

    def delete(self, name: str) -> Json:
        """Deletes a search with all that it found."""
        folder = self._of(name)
        self._queue.cancel(_job(name, folder).scenario)
        shutil.rmtree(folder)
        return {"name": name}

    def ended(self, job: Job, outcome: Outcome) -> None:
        """Notes how a search ended."""
        states, text = States(job.file.parent), outcome.text.replace(f"{self._kept}/", "")
        if outcome.faults is not None:
            states.put([RUN], "done", took=outcome.took)
        else:
            states.put([RUN], "failed" if text else "cancelled", text=text)

    def report(self, name: str) -> str:
        """Returns the report of a search that is over, HTML."""
        return self._text(name, REPORT)

    def layout(self, name: str, layout: str) -> str:
        """Returns the text of a layout of the front."""
        if not is_file_name(layout, SUFFIX):
            raise ScenarioError(f"{layout}: the name of a layout of the front was expected")
        return self._text(name, layout)

    def drawing(self, name: str, layout: str) -> str:
        """Returns the plan of a layout of the front, SVG."""
        self.layout(name, layout)
        path = self._of(name) / layout
        return _drawing(path, shown.changed(path))

    def _text(self, name: str, file: str) -> str:
        try:
            return (self._of(name) / file).read_text("utf-8")
        except OSError as error:
            raise ScenarioError(f"{name}: there is no {file} yet") from error

    def _of(self, name: str) -> Path:
        """Returns the folder of a search. Raises ScenarioError for an unknown name."""
        folder = self._path / _named(name)
        if folder.is_symlink() or not (folder / FILE).is_file():
            raise ScenarioError(f"there is no search '{name}'")
        return folder

    def _shown(self, name: str, active: dict[Job, Active], waiting: set[Job]) -> Json:
        folder = self._path / name
        out: Json = {"name": name, "state": "wrong", "left": 0.0, "front": [], "answer": None}
        try:
            settings = DesignSettings.read(folder)
        except ScenarioError as error:
            return out | {"error": str(error).replace(f"{self._kept}/", "")}
        out["settings"] = settings.to_json()
        if answer := _answer(folder):
            return out | {"state": "done", "answer": answer, "front": _front(folder)}
        job, whole = _job(name, folder), 3600 * settings.cpu_hours / self._queue.processes
        if running := active.get(job):
            return out | {"state": "runs"} | _progress(running, whole)
        if job in waiting:
            return out | {"state": "waits", "left": whole}
        known = States(folder).read().get(str(RUN), {})
        state = known.get("state", "none")
        return out | {
            "state": shown.CUT if state in ("waits", "runs", "done") else state,
            "left": whole,
            "error": known.get("text", ""),
        }


def _named(name: str) -> str:
    try:
        return checked_name(name)
    except ScenarioError as error:
        raise DesignError("name", str(error)) from error


def _job(name: str, folder: Path) -> Job:
    """Returns the job of a search: its name has a character that no scenario's has."""
    return Job(f"{DESIGNS}/{name}", RUN, folder / FILE)


def _progress(running: Active, whole: float) -> Json:
    """Returns the share of a search that is over, its stage, and what is left [s, wall]."""
    news, took = running.progress, time.monotonic() - running.began
    share = min(news.get("time", 0.0), 1.0)
    left = took * (1 - share) / share if share > BEGUN else max(whole - took, 0.0)
    return {"share": share, "stage": news.get("stage", ""), "left": left}


def _answer(folder: Path) -> Json | None:
    """Returns what a search found, in sentences; None before its end."""
    with contextlib.suppress(OSError, ValueError):
        answer = json.loads((folder / ANSWER).read_text("utf-8"))
        return answer if isinstance(answer, dict) else None
    return None


def write_answer(folder: Path, answer: "Answer") -> None:
    """Writes what a search found; with that it is over."""
    beside = folder / f".{ANSWER}.part"
    texts = {"text": answer.text, "why": answer.why, "effort": answer.effort}
    beside.write_text(dumps(texts), "utf-8")
    os.replace(beside, folder / ANSWER)


def _front(folder: Path) -> list[Json]:
    """Returns the layouts of a front, with numbers where there are some."""
    try:
        with (folder / FRONT).open(encoding="utf-8", newline="") as file:
            rows: Iterable[dict[str, str]] = list(csv.DictReader(file))
    except OSError:
        return []
    return [
        {"layout": row["layout"]}
        | {key: _number(row.get(head, "")) for key, head in COLUMNS.items()}
        for row in rows
    ]


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


@functools.lru_cache(50)
def _drawing(path: Path, _: int) -> str:
    """Returns the plan of a layout file of that version, SVG."""
    with tempfile.TemporaryDirectory() as made:
        out = Path(made) / "plan.svg"
        draw.draw(layout_file.read(path), out)
        return out.read_text("utf-8")
