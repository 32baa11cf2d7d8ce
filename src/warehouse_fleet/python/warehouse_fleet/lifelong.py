# SPDX-License-Identifier: Apache-2.0
"""Runs a problem of the League of Robot Runners with a planner, tick by tick."""

import time

import numpy as np

from warehouse_fleet import Fleet
from warehouse_layout import Floor

NOWHERE = -1
LETTERS = np.array(["W", "F", "R", "C"])  # by Action; rows go down, so R is towards +y


class RoundRobin:
    """Task k belongs to robot k mod robots, in the order of the file."""

    def __init__(self, problem):
        self.tasks, self.robots = len(problem.tasks), len(problem.agents)
        self.next = np.arange(self.robots)

    def give(self, free, _cells):
        """A task for each of the robots that are free, as far as there are any."""
        for robot in free:
            if self.next[robot] < self.tasks:
                yield robot, int(self.next[robot])
                self.next[robot] += self.robots


class Nearest:
    """Of the tasks that are known, each robot gets the one that is done soonest."""

    def __init__(self, problem):
        self.width = problem.passable.shape[1]
        self.ends = np.array([[task[0], self._length(task)] for task in problem.tasks])
        self.revealed = max(1, int(problem.reveal * len(problem.agents)))
        self.shown = min(self.revealed, len(self.ends))
        self.open = list(range(self.shown))

    def _length(self, task):
        rows, columns = np.divmod(np.array(task), self.width)
        return int(np.abs(np.diff(rows)).sum() + np.abs(np.diff(columns)).sum())

    def give(self, free, cells):
        for robot in free:
            if not self.open:
                return
            starts, lengths = self.ends[self.open].T
            rows, columns = np.divmod(starts, self.width)
            row, column = divmod(int(cells[robot]), self.width)
            far = np.abs(rows - row) + np.abs(columns - column) + lengths
            yield robot, self.open.pop(int(far.argmin()))
            # As many as were known before are known again.
            if self.shown < len(self.ends):
                self.open.append(self.shown)
                self.shown += 1


class Lifelong:
    """The state of a run. `planner` has plan(fleet, seconds, attempts), as a Door has."""

    def __init__(self, problem, planner):
        self.problem, self.planner = problem, planner
        robots = len(problem.agents)
        width = problem.passable.shape[1]
        self.forward = np.array([1, width, -1, -width], np.int32)
        self.cell = problem.agents.copy()
        self.heading = np.zeros(robots, np.uint8)
        self.goal = np.full(robots, NOWHERE, np.int32)
        self.task = np.full(robots, NOWHERE)
        self.errand = np.zeros(robots, int)
        self.supply = RoundRobin(problem) if problem.round_robin else Nearest(problem)
        self.tick = 0
        self.finished = 0
        self.actions, self.seconds, self.events = [], [], []
        self.schedule = [[] for _ in range(robots)]
        self._give()

    def step(self, seconds=0.0, attempts=-1):
        """One tick: plans, drives, and hands out new tasks."""
        fleet = Fleet(self.cell, self.heading, self.goal)
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

    def _arrive(self, robot):
        task, errands = self.task[robot], self.problem.tasks[self.task[robot]]
        self.errand[robot] += 1
        self.events.append([self.tick, robot, int(task), int(self.errand[robot])])
        if self.errand[robot] < len(errands):
            self.goal[robot] = errands[self.errand[robot]]
            return
        self.finished += 1
        self.task[robot] = self.goal[robot] = NOWHERE

    def _give(self):
        free = np.flatnonzero(self.task == NOWHERE)
        for robot, task in self.supply.give(free, self.cell):
            self.task[robot], self.errand[robot] = task, 0
            self.goal[robot] = self.problem.tasks[task][0]
            self.schedule[robot].append(f"{self.tick}:{task}")

    def result(self):
        """The competition's result, to be written as JSON."""
        width = self.problem.passable.shape[1]
        place = [divmod(int(cell), width) for cell in self.problem.agents]
        letters = LETTERS[np.array(self.actions, int).reshape(self.tick, len(place))]
        paths = [",".join(row) for row in letters.T]
        given = sorted(int(one.split(":")[1]) for row in self.schedule for one in row)
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
            "tasks": [[task, 0, self._errands(task, width)] for task in given],
        }

    def _errands(self, task, width):
        return [part for cell in self.problem.tasks[task] for part in divmod(cell, width)]


def floor_of(problem):
    """Its floor, with no storage places."""
    return Floor(problem.passable)
