# SPDX-License-Identifier: Apache-2.0
"""The order of a plan: which robot enters which cell after which, its rings broken."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from warehouse_fleet.league.league_plan import LeaguePlan
from warehouse_fleet.league.problem import ProblemError
from warehouse_fleet.league.ring_breaking import NO_ROBOT, Move, RingBreaker, rings_of


@dataclass
class DriveOrder:
    """The steps of robots into cells, in the order of their ranks.

    All steps of a tick have one rank; moves that break the rings of a tick come before, each with a
    rank of its own.
    """

    steps: NDArray[np.int32]  # (robots,) how many each robot has
    cell: NDArray[np.int32]  # (sum of steps,) locations entered, robot after robot
    rank: NDArray[np.int32]  # (sum of steps,) ascending for each robot
    rank_of_tick: NDArray[np.int32]  # (ticks,)
    end: NDArray[np.int32]  # (robots,) where each is in the end
    last: NDArray[np.int32]  # (robots,) ticks until it is there by the plan
    rings: int  # how many were broken

    def breaks_ring(self, rank: NDArray[np.integer[Any]]) -> NDArray[np.bool_]:
        """Returns which ranks are of moves that break rings, in the shape of `rank`."""
        return self.rank_of_tick[self.tick(rank)] != rank

    def tick(self, rank: NDArray[np.integer[Any]]) -> NDArray[np.intp]:
        """Returns the ticks of ranks, in the shape of `rank`."""
        return np.searchsorted(self.rank_of_tick, rank)


def order_of(plan: LeaguePlan) -> DriveOrder:
    """Returns the order of a plan; raises ProblemError for a ring around which there is no room."""
    locations = plan.locations()
    moving = locations[:, 1:] != locations[:, :-1]
    last = np.where(moving.any(axis=1), plan.ticks - moving[:, ::-1].argmax(axis=1), 0)
    rings, moves = _break_rings(plan, locations, moving)
    count = np.array([len(of_tick) for of_tick in moves])
    rank_of_tick = np.arange(plan.ticks) + np.cumsum(count)
    robot, tick = np.nonzero(moving)
    steps = [robot, locations[robot, tick + 1], rank_of_tick[tick]]
    if rings:
        steps = _with_moves(steps, moves, rank_of_tick - count)
    return DriveOrder(
        np.bincount(steps[0], minlength=len(locations)).astype(np.int32),
        steps[1].astype(np.int32),
        steps[2].astype(np.int32),
        rank_of_tick.astype(np.int32),
        locations[:, -1],
        last.astype(np.int32),
        rings,
    )


def _break_rings(
    plan: LeaguePlan, locations: NDArray[np.int32], moving: NDArray[np.bool_]
) -> tuple[int, list[list[Move]]]:
    """Takes the rings out of `moving`, (robots, ticks); returns how many there were, and the moves
    instead of them, a list a tick."""
    breaker, rings = RingBreaker(plan.passable), 0
    at = np.full(plan.passable.size, NO_ROBOT)
    robots = np.arange(len(locations))
    instead: list[list[Move]] = []
    for tick in range(plan.ticks):
        before, after = locations[:, tick], locations[:, tick + 1]
        at[before] = robots
        instead.append([])
        for ring in rings_of(before, after, at):
            moves = breaker.moves(ring, before, at)
            if moves is None:
                raise ProblemError(_no_room(plan, tick, ring, before))
            instead[-1] += moves
            at[after[ring]] = ring
            moving[ring, tick] = False
            rings += 1
        at[before] = NO_ROBOT
    return rings, instead


def _no_room(plan: LeaguePlan, tick: int, ring: list[int], cells: NDArray[np.int32]) -> str:
    shown = [divmod(int(cells[robot]), plan.passable.shape[1]) for robot in ring[:4]]
    robots = ", ".join(f"{robot} at {place}" for robot, place in zip(ring, shown))
    return (
        f"{plan.source}: actualPaths: at tick {tick} {len(ring)} robots move around in a ring, "
        f"{robots}{' …' if len(ring) > 4 else ''} (row, column); bodies can't do that at once, and "
        "around them is no room to do it one after the other; a plan without rings was expected"
    )


def _with_moves(
    steps: list[NDArray[Any]], moves: list[list[Move]], first: NDArray[Any]
) -> list[NDArray[Any]]:
    """Returns steps (robot, cell, rank) with moves, a list a tick with its first rank, in the order
    of robots and ranks."""
    rows = [
        (move.robot, move.end, rank)
        for of_tick, begin in zip(moves, first)
        for rank, move in enumerate(of_tick, int(begin))
    ]
    robot, cell, rank = np.concatenate([np.array(steps), np.array(rows).T], axis=1)
    order = np.lexsort((rank, robot))
    return [robot[order], cell[order], rank[order]]
