# SPDX-License-Identifier: Apache-2.0
"""The service that forecasts the shift that runs; its runs are processes beside the node."""

import contextlib
import itertools
import math
import threading
from collections.abc import Sequence
from time import monotonic as clock
from typing import Any, Protocol

import numpy as np
import rospy
from sqlalchemy.engine import Engine

from warehouse_client.command_services import CommandServices
from warehouse_msgs import msg, srv
from warehouse_operations.fleets.availability import Availability
from warehouse_operations.fleets.fleet_now import FleetNow
from warehouse_operations.forecast import comparison
from warehouse_operations.forecast.ahead import Outcome, Task
from warehouse_operations.forecast.bands import QUANTILES, SERIES, Forecast, forecast_of
from warehouse_operations.forecast.fork import Fork, ForkError, of_shift
from warehouse_operations.forecast.request import ForecastError, Request, tasks_of
from warehouse_operations.forecast.workers import BUDGET, Runs, RunsError
from warehouse_operations.ros.operation_messages import header
from warehouse_operations.shift.shift import Shift
from warehouse_operations.stock.site import Site
from warehouse_operations.store import moment

PAUSED = 2.0  # after which a shift whose time stands still is paused [s, wall]
HOUR = 60.0  # how far the shift is looked ahead of without a request [min]
MOST_SECONDS = 3600.0  # the largest budget [s, wall]
NAMES = ("p10", "p50", "p90")


class Host(Protocol):
    """The node whose shift is forecast."""

    @property
    def shift(self) -> Shift:
        """The shift that runs now."""

    @property
    def site(self) -> Site:
        """Its warehouse."""

    @property
    def engine(self) -> Engine:
        """The engine of its database."""

    @property
    def orders_text(self) -> str:
        """What orders come."""

    @property
    def availability(self) -> Availability:
        """What keeps its robots from work."""

    @property
    def elsewhere(self) -> Sequence[str]:
        """Roles of policies that the coordinator has."""

    @property
    def last_step(self) -> float:
        """When the shift was advanced last [s, wall]."""

    def with_fleet(self) -> tuple[Shift, FleetNow]:
        """Returns the shift and its fleet; call it with the lock."""

    @property
    def lock(self) -> Any:
        """The lock of the shift."""


class ForecastService:
    """Answers requests for forecasts, and publishes each on a latched topic.

    every: how often the shift is looked ahead of without a request [s]; 0: never. budget: time for
    as many runs as possible of a request without their number [s, wall].
    """

    def __init__(self, host: Host, every: float = 0.0, budget: float = BUDGET) -> None:
        self._host, self._ids = host, itertools.count(1)
        self._every, self._budget, self._last = every, budget, -math.inf
        self._at_work: threading.Thread | None = None
        self._lock, self._runs = threading.Lock(), Runs([], 0)
        self._newest = 0
        self._topic = rospy.Publisher(
            "warehouse/forecasts", msg.ForecastResult, latch=True, queue_size=1
        )
        CommandServices(rospy).serve("warehouse/forecast", srv.Forecast, self._forecast)

    def close(self) -> None:
        """Ends the processes of a forecast."""
        with self._lock:
            self._runs.give_up()

    def keep_up(self, now: float) -> None:
        """Looks ahead if it is time to, at a time of the shift [s], and no forecast is made. Where
        time stands, as before it begins to pass, that waits."""
        if now < self._last:  # the world was reset
            self._last = -math.inf
        if not self._every or now - self._last < self._every or self._is_paused:
            return
        if self._at_work and self._at_work.is_alive():
            return
        self._last = now
        with contextlib.suppress(ForecastError, ForkError):  # such as an hour without orders
            self._begin(Request(HOUR))

    @property
    def _is_paused(self) -> bool:
        """Whether the time of the shift stands still."""
        return clock() - self._host.last_step > PAUSED

    def _forecast(self, request: Any) -> Any:
        try:
            asked = Request(request.minutes, request.runs, tuple(request.changes))
            return srv.ForecastResponse(self._begin(asked), True, "")
        except (ForecastError, ForkError) as error:
            return srv.ForecastResponse(0, False, str(error))

    def _begin(self, asked: Request) -> int:
        """Begins a forecast, in place of one under way; returns its number. Raises ForecastError,
        ForkError."""
        asked.check()
        tasks, known = self._tasks(asked)
        with self._lock:
            self._runs.give_up()
            self._newest = number = next(self._ids)
            self._runs = runs = Runs(tasks, asked.runs, budget=self._budget)
            self._at_work = threading.Thread(
                target=self._make,
                args=(number, asked, tasks, known, runs),
                name="forecast",
                daemon=True,
            )
            self._at_work.start()
        return number

    def _tasks(self, asked: Request) -> tuple[list[Task], dict[int, tuple[str, float]]]:
        """Forks the shift. Raises ForecastError, ForkError."""
        host = self._host
        if self._is_paused:
            raise ForecastError("the world is paused, or lost: there is nothing to look ahead from")
        recent = (
            moment.recent_orders(host.engine, host.shift.now) if host.orders_text == "none" else ()
        )
        with host.lock:
            shift, fleet = host.with_fleet()
            fork: Fork = of_shift(shift, fleet, recent)
            known = {o.order_id: (o.reference, o.due) for o in shift.orders.values()}
        return tasks_of(asked, host.site, shift, fork, host.availability, host.elsewhere), known

    def _make(
        self,
        number: int,
        asked: Request,
        tasks: Sequence[Task],
        known: dict[int, tuple[str, float]],
        runs: Runs,
    ) -> None:
        """Makes the runs, and publishes what comes of them, or why nothing does."""
        outcomes: list[list[Outcome]] = [[] for _ in tasks]
        try:
            for index, outcome in runs.outcomes():
                outcomes[index].append(outcome)
            ordered = [sorted(each, key=lambda outcome: outcome.number) for each in outcomes]
            forecast = forecast_of(
                tasks[-1], asked.minutes, ordered[-1], known, changes=asked.changes
            )
            text = forecast.text
            if len(ordered) > 1:
                text += f"; against as it is: {comparison.sentence(*ordered)}"
            self._publish(number, message_of(number, forecast, text))
        except RunsError as error:
            if number == self._newest:
                made_at, nothing = tasks[0].fork.time, (math.nan,) * 3
                empty = Forecast(made_at, asked.minutes, 0, asked.changes, np.zeros(0), {}, nothing)
                self._publish(number, message_of(number, empty, f"no forecast: {error}"))

    def _publish(self, number: int, message: Any) -> None:
        with self._lock:
            if number == self._newest:
                self._topic.publish(message)


def message_of(number: int, forecast: Forecast, text: str) -> Any:
    """Returns the ForecastResult of a forecast."""
    bands = {
        f"{name}_{quantile}": forecast.bands[name][i].tolist() if name in forecast.bands else []
        for name in SERIES
        for i, quantile in enumerate(NAMES[: len(QUANTILES)])
    }
    finish = {f"finish_{name}": end for name, end in zip(NAMES, forecast.finish)}
    return msg.ForecastResult(
        header=header(forecast.made_at),
        forecast_id=number,
        made_at=forecast.made_at,
        minutes=forecast.minutes,
        runs=forecast.runs,
        changes=list(forecast.changes),
        time=forecast.times.tolist(),
        text=text,
        **bands,
        **finish,
    )
