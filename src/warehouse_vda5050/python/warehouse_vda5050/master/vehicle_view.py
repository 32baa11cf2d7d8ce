# SPDX-License-Identifier: Apache-2.0
"""What is known of a vehicle from its messages."""

from dataclasses import dataclass, field
from datetime import datetime

from warehouse_vda5050.errors import ErrorLevel
from warehouse_vda5050.master.frame import Frame, Pose
from warehouse_vda5050.master.speedometer import Speedometer
from warehouse_vda5050.model import ConnectionState, OperatingMode, VehicleState
from warehouse_vda5050.paths import sampled

SILENT = 45.0  # [s] without a state: vehicles send one at least each 30 s
TAKES_ORDERS = (OperatingMode.AUTOMATIC, OperatingMode.SEMIAUTOMATIC)


@dataclass
class VehicleView:
    """The newest state of a vehicle, in the warehouse's terms."""

    frame: Frame
    state: VehicleState | None = None
    connection: ConnectionState | None = None
    pose: Pose = (0.0, 0.0, 0.0)  # in the frame world [m, rad]
    heard_at: float = 0.0  # when the last state came [s]
    between: float = 0.0  # its last two states, by our clock or its own, which says more [s]
    reports_loads: bool = False
    misfit: str = ""  # why it can't drive on this floor, '' if it can
    speedometer: Speedometer = field(default_factory=Speedometer, repr=False)
    _stamp: tuple[str, int] = field(default=("", 0), repr=False)

    def take_state(self, state: VehicleState, now: float) -> bool:
        """Adopts a state. Returns False for one that is older than the one before.

        A state is older if both the time and the number of its header are: clocks are set back,
        and numbers begin again at 0.
        """
        time, number = stamp = state.header.timestamp, state.header.header_id
        if time <= self._stamp[0] and number <= self._stamp[1] and stamp != self._stamp:
            return False
        self.between = max(now - self.heard_at, _seconds(self._stamp[0], time))
        self._stamp = stamp
        self.state, self.heard_at = state, now
        self.reports_loads |= bool(state.loads)
        if state.position:
            at = state.position
            self.pose = self.frame.to_world(at.x, at.y, at.theta)
            self.speedometer.take(state, self.pose, now)
        return True

    def take_connection(self, connection: ConnectionState, now: float) -> None:
        """Notes whether the vehicle is connected. One that comes back, even unnoticed, may have
        another clock and count from 0."""
        if connection == ConnectionState.ONLINE:
            self._stamp, self.heard_at = ("", 0), now
            self.speedometer.forget()
        self.connection = connection

    @property
    def is_there(self) -> bool:
        """Whether the vehicle has ever reported a position."""
        return self.state is not None and self.state.position is not None

    @property
    def hears(self) -> bool:
        """Whether the vehicle is connected, by the last message about it."""
        return self.connection in (None, ConnectionState.ONLINE)

    def is_silent(self, now: float) -> bool:
        """Returns whether the vehicle is not connected, or sends nothing."""
        return not self.hears or now > self.heard_at + SILENT

    @property
    def driving(self) -> bool:
        """Whether it says that it drives."""
        return self.state is not None and self.state.driving

    @property
    def map_id(self) -> str:
        """The map that it says it is on."""
        at = self.state.position if self.state else None
        return at.map_id if at else ""

    @property
    def planned_path(self) -> list[tuple[float, float]]:
        """Where it says that it will drive, in the frame world [m]; [] if it does not say."""
        planned = self.state.planned if self.state else None
        points = sampled(planned.trajectory) if planned else []
        return [self.frame.to_world(x, y)[:2] for x, y in points]

    @property
    def waypoints(self) -> list[tuple[float, float, float]]:
        """The points that it says to reach next, x y in the frame world [m], and when [s since
        1970]; [] if it does not say."""
        points = self.state.intermediate if self.state else ()
        return [(*self.frame.to_world(p.x, p.y)[:2], p.eta) for p in points]

    @property
    def is_localized(self) -> bool:
        """Whether it knows where it is."""
        at = self.state.position if self.state else None
        return at is not None and at.initialized

    @property
    def fatal(self) -> list[str]:
        """What a person has to come for, as text."""
        errors = self.state.errors if self.state else ()
        return [f"{e.type}: {e.description}" for e in errors if e.level == ErrorLevel.FATAL]

    @property
    def fatal_types(self) -> list[str]:
        """The types of the errors that a person has to come for."""
        errors = self.state.errors if self.state else ()
        return [e.type for e in errors if e.level == ErrorLevel.FATAL]

    @property
    def takes_orders(self) -> bool:
        """Whether its mode is one in which it takes orders, and it fits the floor."""
        is_in_mode = self.state is not None and self.state.mode in TAKES_ORDERS
        return is_in_mode and not self.misfit

    @property
    def why_not(self) -> str:
        """Why it can't be given an order, '' if it can."""
        if not self.hears:
            return f"its connection is {self.connection.value}" if self.connection else "not there"
        if self.state is None:
            return "it has reported nothing yet"
        if not self.is_localized:
            return "it does not know where it is"
        if self.misfit:
            return f"it does not fit: {self.misfit}"
        if not self.takes_orders:
            return f"its operating mode is {self.state.mode.value}"
        return next((f"it reports {text}" for text in self.fatal), "")


def _seconds(before: str, after: str) -> float:
    """Returns the time between two timestamps [s]: a network may keep states back and bring them
    all at once. 0 where they don't tell."""
    try:
        return (datetime.fromisoformat(after) - datetime.fromisoformat(before)).total_seconds()
    except (ValueError, TypeError):  # TypeError: one has a time zone, and one has none
        return 0.0
