# SPDX-License-Identifier: Apache-2.0
"""Forecasts from any moment of a recorded shift, by the database in the folder of its run."""

import asyncio
import itertools
import json
import math
import threading
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from starlette.requests import Request as HttpRequest
from starlette.responses import Response
from starlette.routing import Route

from warehouse_operations.forecast import comparison, program
from warehouse_operations.forecast.ahead import Outcome
from warehouse_operations.forecast.bands import QUANTILES, SERIES, Forecast, forecast_of
from warehouse_operations.forecast.program import Prepared
from warehouse_operations.forecast.request import ForecastError, Request
from warehouse_operations.forecast.workers import BUDGET, Runs, RunsError
from warehouse_operations.runs import run_files
from warehouse_viewer.json_text import JSONResponse

NAMES = ("p10", "p50", "p90")
FIELDS = ("at", "minutes", "runs", "changes")
MOST_BYTES = 20_000  # of a request
KEPT = 20  # forecasts


class RecordedForecasts:
    """Answers requests for forecasts of the shift in a folder. A newer request takes the place of
    one under way. warehouse: what the run was of: realism and robots. seconds: in which a forecast
    makes as many runs as it can, where a request does not say how many [s, wall]."""

    def __init__(self, database: Path, warehouse: dict[str, Any], seconds: float = BUDGET) -> None:
        self._database, self._warehouse, self._seconds = database, warehouse, seconds
        self._ids, self._lock = itertools.count(1), threading.Lock()
        self._results: dict[int, dict[str, Any]] = {}
        self._runs, self._newest = Runs([], 0), 0

    @classmethod
    def beside(cls, recording: Path, seconds: float = BUDGET) -> "RecordedForecasts | None":
        """Returns the forecasts of a recording's shift; None without its database."""
        folder = recording.parent
        if not (folder / run_files.DATABASE).is_file():
            return None
        try:
            content = json.loads((folder / run_files.RUN).read_text(encoding="utf-8"))
            config = content["config"]
        except (OSError, ValueError, KeyError, TypeError):
            config = {}
        warehouse = config if isinstance(config, dict) else {}
        return cls(folder / run_files.DATABASE, warehouse, seconds)

    def routes(self) -> list[Route]:
        """Returns the routes, to be added to an application."""
        return [
            Route("/api/v1/forecasts", self._ask, methods=["POST"]),
            Route("/api/v1/forecasts/latest", self._latest),
            Route("/api/v1/forecasts/{number:int}", self._get),
        ]

    def close(self) -> None:
        """Ends the processes of a forecast."""
        with self._lock:
            self._runs.give_up()

    async def _ask(self, request: HttpRequest) -> Response:
        try:
            at, asked = asked_of(await request.body())
            prepared = await asyncio.to_thread(self._prepare, at, asked)
        except program.ERRORS as error:
            return JSONResponse({"detail": str(error)}, 409)
        return JSONResponse(self._shown(self._begin(asked, prepared)), 202)

    async def _latest(self, _: HttpRequest) -> Response:
        return self._answer(self._newest)

    async def _get(self, request: HttpRequest) -> Response:
        return self._answer(request.path_params["number"])

    def _answer(self, number: int) -> Response:
        if not 0 < number <= self._newest:
            return JSONResponse({"detail": "there is no such forecast; POST asks for one"}, 404)
        return JSONResponse(self._shown(number))

    def _shown(self, number: int) -> dict[str, Any]:
        if number in self._results:
            return self._results[number]
        state = "RUNNING" if number == self._newest else "REPLACED"
        return {"forecast_id": number, "state": state}

    def _prepare(self, at: float, asked: Request) -> Prepared:
        """Forks the shift as it was at a time [s]."""
        known = self._warehouse
        args = Namespace(
            database=str(self._database),
            at=f"{at:.3f}",
            layout="",
            robots=known.get("robots", 0),
            orders="",
            realism=known.get("realism", "") if known.get("physics", True) else "",
        )
        return program.prepare(args, asked)

    def _begin(self, asked: Request, prepared: Prepared) -> int:
        with self._lock:
            self._runs.give_up()
            self._newest = number = next(self._ids)
            self._runs = runs = Runs(prepared.tasks, asked.runs, budget=self._seconds)
        work = number, asked, prepared, runs
        threading.Thread(target=self._make, args=work, name="forecast", daemon=True).start()
        return number

    def _make(self, number: int, asked: Request, prepared: Prepared, runs: Runs) -> None:
        """Makes the runs, and keeps what comes of them, or why nothing does."""
        tasks = prepared.tasks
        outcomes: list[list[Outcome]] = [[] for _ in tasks]
        try:
            for index, outcome in runs.outcomes():
                outcomes[index].append(outcome)
        except RunsError as error:
            result: dict[str, Any] = {"made_at": tasks[0].fork.time, "minutes": asked.minutes}
            result |= {"runs": 0, "changes": asked.changes, "text": f"no forecast: {error}"}
        else:
            ordered = [sorted(each, key=lambda outcome: outcome.number) for each in outcomes]
            forecast = forecast_of(
                tasks[-1], asked.minutes, ordered[-1], prepared.known, changes=asked.changes
            )
            result = content_of(forecast, ordered)
        with self._lock:
            if number == self._newest:
                self._results[number] = {"forecast_id": number, "state": "DONE"} | result
                self._results.pop(number - KEPT, None)


def asked_of(body: bytes) -> tuple[float, Request]:
    """Returns the time [s] and the Request of a body. Raises ForecastError."""
    try:
        content = json.loads(body) if len(body) <= MOST_BYTES else None
    except ValueError:
        content = None
    if not isinstance(content, dict) or (unknown := content.keys() - set(FIELDS)):
        named = f"{min(unknown)} is unknown: " if isinstance(content, dict) else ""
        raise ForecastError(f"{named}a JSON object with {', '.join(FIELDS)} was expected")
    at = _number(content, "at", None)
    runs = _number(content, "runs", 0)
    changes = content.get("changes", [])
    if not isinstance(changes, list) or not all(isinstance(line, str) for line in changes):
        raise ForecastError("changes has to be a list of events, as '+0 close pick3'")
    if runs != int(runs):
        raise ForecastError(f"runs is {runs:g}; a whole number was expected")
    return at, Request(_number(content, "minutes", 60.0), int(runs), tuple(changes))


def _number(content: dict[str, Any], field: str, usual: float | None) -> float:
    value = content.get(field, usual)
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not is_number or not math.isfinite(value):
        meant = "the time of the shift [s]" if field == "at" else "a number"
        raise ForecastError(f"{field} has to be {meant}")
    return float(value)


def content_of(forecast: Forecast, outcomes: Sequence[Sequence[Outcome]]) -> dict[str, Any]:
    """Returns a Forecast as the HTTP API has it. outcomes: as it is, and with changes if there are
    some."""
    text = forecast.text
    if len(outcomes) > 1:
        text += f"; against as it is: {comparison.sentence(*outcomes)}"
    bands = {
        name: {quantile: forecast.bands[name][i].tolist() for i, quantile in enumerate(NAMES)}
        for name in SERIES
    }
    ends = [None if math.isnan(end) else end for end in forecast.finish]
    return {
        "made_at": forecast.made_at,
        "minutes": forecast.minutes,
        "runs": forecast.runs,
        "changes": list(forecast.changes),
        "time": forecast.times.tolist(),
        "finish": dict(zip(NAMES[: len(QUANTILES)], ends)),
        "text": text,
    } | bands
