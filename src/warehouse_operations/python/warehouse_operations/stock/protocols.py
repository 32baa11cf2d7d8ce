# SPDX-License-Identifier: Apache-2.0
"""The interface between a shift and a fleet: requests for transports, and decisions by policies.

transports.Transports (simulated or real robots) and ideal.IdealFleet both implement Requests. Times
are simulated seconds.
"""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np

from warehouse_fleet.transports.transports import STORE, TransportAnswer, TransportEvent


class Task(NamedTuple):
    """A transport that waits for a robot."""

    transport_id: int
    shelf_id: int
    station: str
    priority: int
    inbound: int  # units at its station or on the way to it


class Hooks(Protocol):
    """The decisions that a fleet leaves to policies."""

    def choose_place(self, shelf_id: int, cells: np.ndarray, distances: np.ndarray) -> int:
        """Returns the cell, one of `cells`, in which a unit is stored.

        cells: (n,). distances: the way to each of them [m], (n,).
        """

    def match_robots(
        self, tasks: Sequence[Task], robots: Sequence[int], seconds: np.ndarray
    ) -> Iterable[tuple[int, int]]:
        """Returns pairs (index of the task, index of the robot), each at most once.

        robots: their kiva_ids. seconds: (tasks, robots), until a robot is beneath a task's unit.
        """

    @property
    def charging(self) -> Any:
        """The policy that decides when robots charge; see policies.ChargingPolicy."""

    def park(self, kiva_id: int, cell: int) -> int | None:
        """Returns the cell to which a robot without work goes; None: it waits where it is."""


class Requests(Protocol):
    """The requests to a fleet. After CANCELLED of a lifted unit, STORED follows."""

    def submit(
        self,
        shelf_id: int,
        station: str = "",
        x: float | None = None,
        y: float | None = None,
        then: int = STORE,
        priority: int = 0,
    ) -> TransportAnswer:
        """Asks for a transport to a station, or to the cell at x, y in world [m]."""

    def release(self, transport_id: int) -> tuple[bool, str]:
        """Lets a unit leave its station. Returns success and the fault."""

    def cancel(self, transport_id: int) -> tuple[bool, str]:
        """Cancels a transport; a lifted unit is stored. Returns success and the fault."""

    def set_open(self, station: str, is_open: bool) -> None:
        """Opens a station, or closes it and cancels the units on their way there."""

    def take_events(self) -> list[TransportEvent]:
        """Returns what happened since the last call, in order."""
