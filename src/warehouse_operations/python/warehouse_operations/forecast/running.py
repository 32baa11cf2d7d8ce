# SPDX-License-Identifier: Apache-2.0
"""Forecasts of a shift that runs in this process: of Operations, with ideal or simulated robots.

with open_operations(Description("medium", orders="poisson:820")) as ops:
    ops.run(minutes=40)
    (forecast,) = running.forecasts(ops, Request(minutes=30, runs=12, physics=True))
    print(forecast.text)
"""

from dataclasses import replace

from warehouse_operations.fleets import fleet_now
from warehouse_operations.fleets.availability import Availability
from warehouse_operations.fleets.ideal import IdealFleet
from warehouse_operations.forecast.ahead import Outcome, Task
from warehouse_operations.forecast.bands import Forecast, forecast_of
from warehouse_operations.forecast.fork import Fork, of_shift
from warehouse_operations.forecast.request import Request, tasks_of
from warehouse_operations.forecast.workers import Runs
from warehouse_operations.runs.operations import Operations


def fork_of(ops: Operations, physics: bool = False) -> Fork:
    """Returns the fork of a shift; for simulated robots, with a checkpoint of their world. Raises
    ForkError."""
    fork = of_shift(ops.shift, fleet_now.of(ops.fleet))
    if not physics or isinstance(ops.fleet, IdealFleet):
        return fork
    return replace(fork, world=ops.fleet.world.checkpoint())


def forecasts(
    ops: Operations,
    asked: Request,
    availability: Availability | None = None,
    processes: int | None = None,
) -> list[Forecast]:
    """Returns what comes of a shift, which does not go on meanwhile: as it is and, if changes are
    asked for, with them.

    availability: of ideal robots; simulated ones have that of their world. Raises ForecastError,
    ForkError, RunsError.
    """
    tasks = tasks_of(asked, ops.site, ops.shift, fork_of(ops, asked.physics), availability)
    known = {o.order_id: (o.reference, o.due) for o in ops.shift.orders.values()}
    outcomes = _outcomes(tasks, asked, processes)
    return [
        forecast_of(task, asked.minutes, runs, known, changes=changes)
        for task, runs, changes in zip(tasks, outcomes, ((), asked.changes))
    ]


def _outcomes(tasks: list[Task], asked: Request, processes: int | None) -> list[list[Outcome]]:
    out: list[list[Outcome]] = [[] for _ in tasks]
    for index, outcome in Runs(tasks, asked.runs, processes=processes).outcomes():
        out[index].append(outcome)
    return [sorted(each, key=lambda outcome: outcome.number) for each in out]
