# SPDX-License-Identifier: Apache-2.0
"""The emergency stop of the whole fleet: time goes on, and no robot moves until it is released."""

from __future__ import annotations

import threading
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

from warehouse_msgs.msg import Stop

if TYPE_CHECKING:
    from warehouse_client.heard_commands import Heard
    from warehouse_msgs.msg import FleetState

SETTLES = 40.0  # for which robots may stand yet after a stop [s], simulated
ALL = 0  # the number that stands for every robot in a Stop
HELD = "warehouse/emergency_stop"  # the parameter that outlasts a viewer


class Hold(NamedTuple):
    """A stop that holds: `by` whom (may be empty), and since when [s], simulated."""

    by: str
    since: float


class EmergencyStop:
    """Stops all robots over /stop, and those that are added or restored while the stop holds.

    Stops that other clients publish for the whole fleet hold here, too, once `hear` has them. `ros`
    is rospy.
    """

    def __init__(self, ros: ModuleType) -> None:
        self._ros, self._lock = ros, threading.Lock()
        self._publisher = ros.Publisher("stop", Stop, queue_size=10)
        self._now = 0.0
        self._world: tuple[int, tuple[int, ...]] | None = None  # timeline and robots
        self._hold = self._kept()
        self._has_stopped = self._hold is not None
        self._released: float | None = None  # [s], simulated
        self._topic = ros.resolve_name("stop")

    @property
    def hold(self) -> Hold | None:
        """The stop that holds now; None: robots may move."""
        return self._hold

    @property
    def is_felt(self) -> bool:
        """Whether robots stand for a stop that holds, or for one that ended a moment ago."""
        since = self._now - self._released if self._released is not None else SETTLES
        return self._hold is not None or 0 <= since < SETTLES

    def stop(self, by: str) -> str:
        """Stops every robot; returns what was done."""
        with self._lock:
            if self._hold is None:
                self._set(Hold(by, self._now))
        self._publish(True)
        return "every robot stops, and stands until the stop is released"

    def release(self) -> str:
        """Lets every robot go on with what it did; returns what was done."""
        with self._lock:
            was = self._hold
            self._set(None)
        self._publish(False)
        return "the robots go on" if was else "no stop was held; the robots go on"

    def keep(self, fleet: FleetState | None) -> None:
        """Stops robots that came since, and those of a world that was reset or restored."""
        if fleet is None:
            return
        self._now = fleet.stamp.to_sec()
        world = int(fleet.timeline), tuple(int(number) for number in fleet.kiva_id)
        before, self._world = self._world, world
        if before == world:
            return
        if self._hold:
            self._publish(True)
        elif before and before[0] != world[0] and self._has_stopped:
            self._publish(False)  # a checkpoint of during the stop has stopped robots

    def hear(self, command: Heard) -> None:
        """Takes a stop of the fleet by another client, or its end."""
        robots, stop = command.fields.get("kiva_id"), command.fields.get("stop")
        if command.topic != self._topic or robots != ALL or stop is None:
            return
        is_stop = bool(stop)
        with self._lock:
            if is_stop != (self._hold is not None):
                self._set(Hold("", self._now) if is_stop else None)

    def _publish(self, stop: bool) -> None:
        self._publisher.publish(Stop(kiva_id=ALL, stop=stop))

    def _set(self, hold: Hold | None) -> None:
        if self._hold and not hold:
            self._released = self._now
        self._hold = hold
        self._has_stopped |= hold is not None
        self._ros.set_param(HELD, hold._asdict() if hold else {})

    def _kept(self) -> Hold | None:
        kept: Any = self._ros.get_param(HELD, None)
        try:
            return Hold(str(kept["by"]), float(kept["since"])) if kept else None
        except (KeyError, TypeError, ValueError):  # another program wrote it
            return None
