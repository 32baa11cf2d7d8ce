# SPDX-License-Identifier: Apache-2.0
"""What a page shows and controls: a warehouse behind ROS, or a world of this process.

The server sees a warehouse only through a Source. Behind ROS `ros.feed.Feed` and
`ros.simulation.Simulation` fill it; `world_source.source_of` makes one for a world of this process.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from warehouse_viewer.page.journal import Journal

if TYPE_CHECKING:
    from warehouse_msgs.msg import CoordinatorState


class RefusedError(RuntimeError):
    """The simulation refuses a command or can't carry it out; the message gives the reason."""


class AwayError(RuntimeError):
    """The simulation does not answer."""


class Feed(Protocol):
    """The newest messages that describe the warehouse, laid out as the ROS messages of that name.

    `feed[name]` returns the newest message, or None:

        fleet         warehouse_msgs/FleetState, with numpy arrays
        objects       warehouse_msgs/WarehouseObjects
        states        warehouse_msgs/UnitStates, with numpy arrays
        scenery       warehouse_msgs/Scenery
        performance   anything with `real_time_factor`, simulated seconds per wall second
        paths         warehouse_msgs/FleetPaths
        ways          warehouse_msgs/CoordinatorPaths, with numpy arrays
        frames        tf2_msgs/TFMessage, where the lasers are mounted
        scan<id>      sensor_msgs/LaserScan of that robot
        requested     numbers of the storage units that learning robots are asked for

    paths, ways, frames and scans come only after subscribe_extras() has asked for them, if at all.
    """

    def __getitem__(self, name: str) -> Any: ...

    @property
    def is_complete(self) -> bool:
        """Whether fleet, scenery, and objects with their states are there."""

    @property
    def objects_and_states(self) -> tuple[Any, Any] | None:
        """(WarehouseObjects, UnitStates) of the same revision; None if there are none yet."""

    @property
    def coordinator(self) -> CoordinatorState | None:
        """The newest warehouse_msgs/CoordinatorState; None if no coordinator runs."""

    def subscribe(self) -> None:
        """Keeps messages coming for a while; called again and again while a page is open."""

    def unsubscribe_if_idle(self) -> bool:
        """Drops subscriptions and messages that no page has used lately; True if it did."""

    def subscribe_extras(self, paths: bool, ways: bool, scans: Sequence[int]) -> None:
        """Asks for paths, for ways, and for the scans of exactly these robots (ids)."""


class Simulation(Protocol):
    """The commands of the page's control bar. Any thread may call; calls may block.

    Commands return the simulation's message, which may be empty, and raise RefusedError or
    AwayError.
    """

    def offers(self) -> dict[str, str | None]:
        """Returns {command: the reason why it is not available, or None}."""

    def state(self) -> dict[str, Any]:
        """Returns `paused`, `target_factor` (0: as fast as possible) and `step_size` [s]."""

    def warehouse(self) -> tuple[str, int]:
        """Returns the warehouse's name and id."""

    def pause(self) -> str:
        """Stops simulated time."""

    def resume(self) -> str:
        """Resumes simulated time."""

    def step(self, steps: int) -> str:
        """Advances a paused simulation by a number of physics steps."""

    def speed(self, factor: float) -> str:
        """Sets the target: simulated seconds per wall second, 0 for as fast as possible."""


@dataclass(frozen=True)
class Source:
    """Everything that a page's server needs to know of a warehouse.

    `describe_coordinator` turns the feed's CoordinatorState into what JSON can say; a feed that
    never has one needs none. `explain` returns why a robot or station waits, or None; `stopped`
    who holds the fleet by an emergency stop, or None; `describe_zones` turns its ClosedZones into
    what JSON can say.
    """

    feed: Feed
    simulation: Simulation
    journal: Journal
    describe_coordinator: Callable[[Any], dict[str, Any]] | None = None
    explain: Callable[[str], dict[str, Any] | None] | None = None
    stopped: Callable[[], str | None] = lambda: None
    describe_zones: Callable[[Any], dict[str, Any]] | None = None
