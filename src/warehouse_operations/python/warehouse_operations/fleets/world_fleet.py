# SPDX-License-Identifier: Apache-2.0
"""The simulated robots of a world as the fleet of a shift; ideal.IdealFleet is the other fleet."""

from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from warehouse_fleet.hosts.fleet_driver import UPDATE, FleetDriver
from warehouse_fleet.transports.transport_book import Transport
from warehouse_layout.message_enums import FailureKind, RobotMode
from warehouse_operations.fleets.activities import ActivityLog
from warehouse_operations.stock.protocols import Hooks, Task
from warehouse_operations.stock.travel import Travel

TOW_AFTER = 60.0  # until people come to a broken robot that blocks others [s]
DEADLOCKED = 60.0  # standstill after which a robot with a goal counts as stuck [s]


class WorldFleet(FleetDriver):
    """A FleetDriver that decides by policies, with the figures of a report."""

    def __init__(
        self,
        world: Any,
        site: Any,
        seed: int,
        threads: int = 0,
        planner: Any = None,
        takes_over_at: float | None = None,
    ) -> None:
        super().__init__(
            world,
            seed,
            planner,
            site.kinematics,
            tow_after=TOW_AFTER,
            threads=threads,
            plan=site.plan,
            takes_over_at=takes_over_at,
        )
        self.robot_count = len(site.robots)
        self.travel = Travel(site.plan, site.kinematics)
        self._cells = self.robots.cell
        self._activities = ActivityLog()
        self._passages, self._waiting = np.zeros((2, site.plan.passable.size))

    def set_hooks(self, hooks: Hooks) -> None:
        """Sets the policies that decide from now on."""
        self._hooks = hooks
        self.transports.match_robots = self._match_robots
        self.transports.choose_place = self._choose_place
        self.transports.park = self._park
        self.transports.charging.policy = hooks.charging

    def _match_robots(
        self, asked: list[Transport], free: np.ndarray
    ) -> Iterator[tuple[Transport, int]]:
        transports = self.transports
        cells = [transports.cell_of_unit[transport.shelf] for transport in asked]
        seconds, _ = self.travel.unloaded(cells, self.robots.cell[free])
        waiting = Counter(transport.station for transport in asked)
        tasks = [
            Task(
                transport.number,
                transport.shelf,
                transport.station,
                transport.priority,
                transports.waiting(transport.station) + waiting[transport.station],
            )
            for transport in asked
        ]
        robots = self.robots.kiva_ids[free].tolist()
        for task, robot in self._hooks.match_robots(tasks, robots, seconds):
            yield asked[task], free[robot]

    def _choose_place(self, shelf_id: int, cell: int, free: np.ndarray) -> int:
        metres = self.travel.metres_to_places(cell, free)
        return self._hooks.choose_place(shelf_id, free, metres)

    def _park(self, robot: int) -> int | None:
        """Returns where a robot without work waits: it rides no elevator to park."""
        robots = self.robots
        at = int(robots.cell[robot])
        cell = self._hooks.park(int(robots.kiva_ids[robot]), at)
        tier = self.plan.tier.flat
        return None if cell is not None and tier[cell] != tier[at] else cell

    def step(self) -> None:
        """Advances by 0.1 s; counts the robots through each cell and their activities."""
        super().step()
        robots = self.robots
        cells, inside = robots.cell, robots.cell >= 0
        came = inside & robots.loaded & (cells != self._cells)
        np.add.at(self._passages, cells[came], 1)
        standing = inside & (robots.still_since < self.traffic.time)
        np.add.at(self._waiting, cells[standing], UPDATE)
        self._activities.observe(UPDATE, self.transports, standing)
        self._cells = cells

    def set_in_service(self, kiva_id: int, in_service: bool) -> None:
        """Takes a robot out of service where it is, or back."""
        mode = RobotMode.AUTOMATIC if in_service else RobotMode.OUT_OF_SERVICE
        if cancels := self.controller.set_mode(kiva_id, mode):
            self.world.cancel(cancels)

    def fail(self, kiva_id: int, duration: float) -> None:
        """Has a robot's drive fail, until it is repaired [s]."""
        self.world.fail(kiva_id, int(FailureKind.MOTOR), duration)

    def passages(self) -> np.ndarray:
        """Returns the number of passes of loaded robots through each cell, (h, w)."""
        return self._passages.reshape(self.plan.shape)

    def waiting_map(self) -> np.ndarray:
        """Returns the robot-seconds that robots under way stood in each cell, (h, w)."""
        return self._waiting.reshape(self.plan.shape)

    def activities(self) -> dict[str, float]:
        """Returns the robot-seconds spent on each of activities.ACTIVITIES up to now."""
        return self._activities.seconds

    @property
    def energy(self) -> dict[str, float]:
        """The state of batteries, and the share of the robots' time at chargers; empty without
        batteries."""
        charge = self.robots.charge
        if not (charge < 1).any():
            return {}
        return {
            "charge_mean": float(charge.mean()),
            "charge_least": float(charge.min()),
            "charging_fraction": self.transports.charging.robot_s
            / max(self.failures.robot_s, 1e-9),
        }

    @property
    def fallen_items(self) -> list[str]:
        """The names of items that lie on the floor."""
        return [f"item{item}" for item in self.fallen]

    @property
    def stuck(self) -> int:
        """The number of robots that have a goal and stand still for DEADLOCKED."""
        robots = self.robots
        going = (robots.goal >= 0) & (robots.goal != robots.cell) & ~robots.busy
        return int(np.count_nonzero(going & (self.traffic.watchdog.stuck_for > DEADLOCKED)))

    def state_hash(self) -> int:
        """Returns the digest of the world's state."""
        return self.world.state_hash()
