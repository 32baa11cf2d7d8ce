# SPDX-License-Identifier: Apache-2.0
"""What a robot sees of the floor and of the fleet near it, a row of numbers for each cell that it
could enter next: what learned planners decide by."""

import functools

import numpy as np

from warehouse_fleet import Fleet
from warehouse_fleet.planners.pibt import NOWHERE
from warehouse_layout import Floor

CACHED = 64_000_000  # bytes of ways that are kept
STAYS = 0  # the first of the candidates; behind it the neighbours in the directions of headings
UNREACHED = 1 << 20  # cells; no way
PATIENCE = 3.0  # ticks of waiting that weigh as much as a cell of the way


class Scene:
    """A fleet at a tick: cell, heading, goal, loaded, home, (robots,) each. `intent`: the cell that
    each robot was sent to a tick before, NOWHERE: none; waited: ticks without progress."""

    def __init__(self, fleet: Fleet, waited: np.ndarray) -> None:
        n = len(fleet)
        # What is driven around: cells that are closed for longer than others' next moves.
        standing = fleet.cell[fleet.stopped.astype(bool)] if fleet.stopped.size else []
        self.obstacles = frozenset(getattr(fleet, "obstacles", fleet.closed)) | set(standing)
        self.cell, self.heading = fleet.cell.astype(int), fleet.heading.astype(int)
        self.goal = fleet.goal.astype(int)
        self.loaded = fleet.loaded.astype(bool) if fleet.loaded.size else np.zeros(n, bool)
        self.home = fleet.home.astype(int) if fleet.home.size else np.full(n, NOWHERE)
        self.tight = np.isin(self.cell, fleet.tight)
        self._tight = fleet.tight
        self.waited, self.intent = waited, np.full(n, NOWHERE)
        # What LocalView has found at this tick.
        self.targets: np.ndarray | None = None
        self.ways: list[np.ndarray | None] | None = None

    def move(self, cell: np.ndarray, heading: np.ndarray) -> None:
        """Moves the robots to their cells and headings of the next tick."""
        self.cell, self.heading = cell, heading
        self.targets = self.ways = None
        self.tight = np.isin(cell, self._tight)


class LocalView:
    """The views of robots on a floor."""

    FEATURES = 16

    def __init__(self, floor: Floor) -> None:
        self.step = np.array([1, floor.width, -1, -floor.width])
        # By cell, with a last row for NOWHERE.
        edges = [np.vstack([floor.edges(deck), np.full(4, NOWHERE)]) for deck in (False, True)]
        self._edges = np.stack(edges)
        self._is_lane = np.array([floor.is_lane(c) for c in range(floor.size)] + [False])
        self._is_aisle = (self._edges[1] != NOWHERE).any(1)
        self._ways_out = (self._edges[0] != NOWHERE).sum(1)
        self._size = floor.size
        kept = max(64, CACHED // (4 * (floor.size + 1)))
        self.far = functools.lru_cache(maxsize=kept)(self._far)

    def targets(self, scene: Scene) -> np.ndarray:
        """Returns the cells that each robot could enter, (robots, 5), NOWHERE: no way."""
        if scene.targets is None:
            under, aisles = self._edges[:, scene.cell]
            at_home = (under == scene.home[:, None]) & (under != NOWHERE)
            beside = np.where(scene.loaded[:, None] & ~at_home, aisles, under)
            scene.targets = np.column_stack([scene.cell, beside])
        return scene.targets

    def rows(self, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
        """Returns the features of each candidate, (robots, 5, FEATURES), and which are valid."""
        targets = self.targets(scene)
        far, quarters = self._far_of(scene, targets), self._quarters(scene)
        possible = self._possible(scene, targets, far, quarters)
        best = targets[np.arange(len(targets)), np.where(possible, far, np.inf).argmin(1)]
        gains = np.clip(far[:, :1] - far, -2, 2) / 2
        stays = np.zeros(targets.shape)
        stays[:, STAYS] = 1
        # The robot that stands in each cell, or NOWHERE.
        holder = np.full(self._size + 1, NOWHERE)
        holder[scene.cell] = np.arange(len(targets))
        other = np.where(stays, NOWHERE, holder[targets])
        held = other != NOWHERE
        features = [
            gains,
            quarters / 2,
            stays,
            held,
            *self._holders(scene, other, best),
            *self._rivals(scene, targets, best),
            self._is_held_beyond(targets, holder),
            targets == scene.goal[:, None],
            held & scene.loaded[:, None],
            targets == scene.intent[:, None],
            self._ways_out[targets] / 4,
            gains * held,
            self._is_aisle[targets],
        ]
        return np.stack(features, axis=-1).astype(np.float32), possible

    def _possible(
        self, scene: Scene, targets: np.ndarray, far: np.ndarray, quarters: np.ndarray
    ) -> np.ndarray:
        """(robots, 5) bool: no lane is a short cut, and a load is not turned in a tight cell."""
        possible = (targets != NOWHERE) & (far < UNREACHED)
        possible[:, STAYS] = True
        lane = self._is_lane
        short_cut = lane[targets] & ~lane[scene.cell, None] & ~lane[scene.goal, None]
        turns_tight = (scene.tight & scene.loaded)[:, None] & (quarters > 0)
        return possible & ~short_cut & ~turns_tight

    def _holders(self, scene: Scene, other: np.ndarray, best: np.ndarray) -> list[np.ndarray]:
        """Returns, for the robot that stands in each candidate, (robots, 5) bool each: whether it
        heads the same way, wants to come here, and is where it is to be."""
        held, direction = other != NOWHERE, np.array([0, 0, 1, 2, 3])
        rests = (scene.goal == NOWHERE) | (scene.goal == scene.cell)
        return [
            held & (scene.heading[other] == direction),
            held & (best[other] == scene.cell[:, None]),
            held & rests[other],
        ]

    def _rivals(self, scene: Scene, targets: np.ndarray, best: np.ndarray) -> list[np.ndarray]:
        """(robots, 5) each: how many others want to enter, up to 3, and whether one of them chooses
        before."""
        rank = self.ranks(scene)
        wanting = np.zeros(self._size + 1)
        np.add.at(wanting, best, 1.0)
        first = np.full(self._size + 1, np.inf)
        np.minimum.at(first, best, rank)
        others = wanting[targets] - (best[:, None] == targets)
        return [np.minimum(others, 3) / 3, first[targets] < rank[:, None]]

    def ranks(self, scene: Scene) -> np.ndarray:
        """Returns a rank for each robot, (robots,); the robot with the least rank chooses first.

        The rank is the cells that are left to go, less what the robot has waited. Robots without a
        goal come last.
        """
        far = [
            UNREACHED if table is None else table[cell]
            for table, cell in zip(self._tables(scene), scene.cell.tolist())
        ]
        return np.array(far, float) - scene.waited / PATIENCE

    def _quarters(self, scene: Scene) -> np.ndarray:
        """(robots, 5): quarter turns before each candidate."""
        turn = (np.arange(4) - scene.heading[:, None]) & 3
        return np.column_stack([np.zeros(len(turn), int), np.minimum(turn, 4 - turn)])

    def _is_held_beyond(self, targets: np.ndarray, holder: np.ndarray) -> np.ndarray:
        """(robots, 5) bool: whether a robot stands behind each candidate, straight on."""
        beyond = np.full(targets.shape, NOWHERE)
        for direction in range(4):
            beyond[:, direction + 1] = self._edges[0][targets[:, direction + 1], direction]
        beyond = np.where(targets == NOWHERE, NOWHERE, beyond)
        return (holder[beyond] != NOWHERE) & (beyond != NOWHERE)

    def _far_of(self, scene: Scene, targets: np.ndarray) -> np.ndarray:
        """(robots, 5): cells from each candidate to the robot's goal."""
        out = np.zeros(targets.shape)
        for robot, table in enumerate(self._tables(scene)):
            if table is not None:
                out[robot] = table[targets[robot]]
        return out

    def _tables(self, scene: Scene) -> list[np.ndarray | None]:
        """Returns, for each robot, the cells to its goal around obstacles, or through them if need
        be."""
        if scene.ways is not None:
            return scene.ways
        out: list[np.ndarray | None] = []
        for goal, loaded, cell in zip(
            scene.goal.tolist(), scene.loaded.tolist(), scene.cell.tolist()
        ):
            table = None if goal == NOWHERE else self.far(goal, loaded, scene.obstacles)
            if table is not None and table[cell] >= UNREACHED:
                table = self.far(goal, loaded, frozenset())
            out.append(table)
        scene.ways = out
        return out

    def _far(self, goal: int, loaded: bool, obstacles: frozenset[int]) -> np.ndarray:
        """Cells from each to a goal, (cells + 1,) int32; a loaded robot's may be a storage place,
        into which aisles don't lead."""
        under, aisles = self._edges
        edges = np.where(under == goal, goal, aisles) if loaded else under
        if obstacles:
            edges = np.where(np.isin(edges, list(obstacles - {goal})), NOWHERE, edges)
        begins, _ = np.nonzero(edges != NOWHERE)
        ends = edges[edges != NOWHERE]
        order = np.argsort(ends, kind="stable")
        before, offsets = begins[order], np.searchsorted(ends[order], np.arange(self._size + 2))
        far = np.full(self._size + 1, UNREACHED, np.int32)
        far[goal], front, steps = 0, np.array([goal]), 0
        while front.size:
            steps += 1
            ahead_in = [before[offsets[c] : offsets[c + 1]] for c in front.tolist()]
            front = np.unique(np.concatenate(ahead_in))
            front = front[far[front] == UNREACHED]
            far[front] = steps
        return far
