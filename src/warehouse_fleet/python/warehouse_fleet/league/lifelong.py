# SPDX-License-Identifier: Apache-2.0
"""Runs a problem of the League of Robot Runners with a planner, tick by tick."""

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from warehouse_fleet import Fleet
from warehouse_fleet._core import PURSUING
from warehouse_fleet.league.delays import Delays
from warehouse_fleet.league.problem import Problem
from warehouse_fleet.league.schedulers import NOWHERE, RoundRobin, Scheduler, Shortest
from warehouse_fleet.planners.planner_plugins import ActionPlanner
from warehouse_layout import Floor

LETTERS = np.array(["W", "F", "R", "C"])  # by Action; rows go down, so R is towards +y


class Lifelong:
    """A run of a problem, tick by tick, from its starts.

    Attributes: `tick` (ticks so far), `finished` (tasks done), `seconds` (computing time of the
    planner, one element a tick [s]); one element a robot have `cell`, `heading` (quarter turns from
    +x towards +y), `goal` (a cell), `task` and `errand` (how many errands of its task are done).
    """

    def __init__(
        self, problem: Problem, planner: ActionPlanner, pursuing: float = PURSUING
    ) -> None:
        """pursuing: how many robots have tasks at a time, as a share of the passable cells."""
        self.problem, self.planner = problem, planner
        robots = len(problem.agents)
        width = problem.passable.shape[1]
        self.forward = np.array([1, width, -1, -width], np.int32)
        self.cell = problem.agents.copy()
        self.heading = np.zeros(robots, np.uint8)
        self.goal = np.full(robots, NOWHERE, np.int32)
        self.task = np.full(robots, NOWHERE)
        self.errand = np.zeros(robots, int)
        self.scheduler: Scheduler = (
            RoundRobin(problem) if problem.round_robin else Shortest(problem, pursuing)
        )
        self.delays = Delays(problem.delays, robots) if problem.delays else None
        self.tick = 0
        self.finished = 0
        self.actions: list[NDArray[np.uint8]] = []
        self.seconds: list[float] = []
        self.events: list[list[int]] = []  # [tick, robot, task, errand] as errands are done
        self.schedule: list[list[str]] = [[] for _ in range(robots)]  # "tick:task"
        self._give()

    def step(self, seconds: float = 0.0, attempts: int = -1) -> None:
        """Plans and drives one tick, and hands out new tasks. `seconds` and `attempts` limit the
        planner, see ActionPlanner.plan. Raises PlanRefusedError."""
        stopped = self.delays.step() if self.delays else None
        fleet = Fleet(self.cell, self.heading, self.goal, stopped=stopped)
        begin = time.thread_time()
        actions = self.planner.plan(fleet, seconds, attempts)[:, 0]
        self.seconds.append(time.thread_time() - begin)
        self.actions.append(actions)
        self.cell = np.where(actions == 1, self.cell + self.forward[self.heading], self.cell)
        turn = np.array([0, 0, 1, 3], np.uint8)[actions]
        self.heading = (self.heading + turn) & 3
        self.tick += 1
        for robot in np.flatnonzero(self.cell == self.goal):
            self._arrive(int(robot))
        self._give()

    def _arrive(self, robot: int) -> None:
        task, errands = self.task[robot], self.problem.errands(self.task[robot])
        self.errand[robot] += 1
        self.events.append([self.tick, robot, int(task), int(self.errand[robot])])
        if self.errand[robot] < len(errands):
            self.goal[robot] = errands[self.errand[robot]]
            return
        self.finished += 1
        self.task[robot] = self.goal[robot] = NOWHERE
        self.errand[robot] = 0

    def _give(self) -> None:
        dealt = [*self.scheduler.give(self.task, self.errand, self.cell, self.finished)]
        for robot, task in dealt:
            self.task[robot], self.errand[robot] = task, 0
            self.goal[robot] = self.problem.errands(task)[0]
            self.schedule[robot].append(f"{self.tick}:{task}")

    def result(self) -> dict[str, Any]:
        """Returns the result in the competition's format, to be written as JSON."""
        width = self.problem.passable.shape[1]
        place = [divmod(int(cell), width) for cell in self.problem.agents]
        letters = LETTERS[np.array(self.actions, int).reshape(self.tick, len(place))]
        paths = [",".join(row) for row in letters.T]
        errand = sorted({int(entry.split(":")[1]) for row in self.schedule for entry in row})
        return {
            "actionModel": "MAPF_T",
            "version": "2024 LoRR",
            "AllValid": "Yes",
            "teamSize": len(place),
            "start": [[row, column, "E"] for row, column in place],
            "numTaskFinished": self.finished,
            "sumOfCost": self.tick * len(place),
            "makespan": self.tick,
            "actualPaths": paths,
            "plannerPaths": paths,
            "plannerTimes": [round(seconds, 6) for seconds in self.seconds],
            "errors": [],
            "scheduleErrors": [],
            "actualSchedule": [",".join(row) for row in self.schedule],
            "plannerSchedule": [",".join(row) for row in self.schedule],
            "events": self.events,
            "tasks": [[task, 0, self._errands(task, width)] for task in errand],
        }

    def _errands(self, task: int, width: int) -> list[int]:
        return [part for cell in self.problem.errands(task) for part in divmod(cell, width)]


def floor_of(problem: Problem) -> Floor:
    """Returns the floor of a problem, without storage places."""
    return Floor(problem.passable)
