# SPDX-License-Identifier: Apache-2.0
"""The coordinator as its services offer it: transports, and who commands a robot."""

from types import ModuleType
from typing import Any

from warehouse_client.message_names import MODE, THEN
from warehouse_msgs.srv import (
    CloseZone,
    OpenZone,
    ReleaseTransport,
    SetRobotMode,
    Tow,
    Transport,
)
from warehouse_viewer.page.source import RefusedError
from warehouse_viewer.ros.simulation import is_offered, request

SERVICES = {
    Transport: "warehouse/transport",
    ReleaseTransport: "warehouse/release_transport",
    SetRobotMode: "warehouse/set_robot_mode",
    Tow: "warehouse/tow",
    CloseZone: "warehouse/close_zone",
    OpenZone: "warehouse/open_zone",
}
NONE_RUNS = "no coordinator runs: start with coordinator:=true"
_MODES = {name: number for number, name in MODE.items()}
_THEN = {name: number for number, name in THEN.items()}


class Coordination:
    """One client of those services; calls block. `ros` is rospy.

    What is asked of the coordinator raises RefusedError, AwayError.
    """

    def __init__(self, ros: ModuleType) -> None:
        self._ros = ros

    def runs(self) -> bool:
        """Returns whether a coordinator runs. Raises AwayError."""
        return is_offered(self._ros, SERVICES[Transport])

    def submit(
        self,
        storage_unit: int,
        station: str,
        x: float | None,
        y: float | None,
        then: str,
        priority: int,
    ) -> int:
        """Submits a transport to a station or to the cell at (x, y) [m]; returns its number."""
        answer = self._call(
            Transport,
            shelf_id=storage_unit,
            station=station,
            x=x or 0.0,
            y=y or 0.0,
            then=_THEN[then],
            priority=priority,
        )
        if not answer.accepted:
            raise RefusedError(answer.message)
        return answer.transport_id

    def release(self, transport: int) -> str:
        """Releases a transport whose station is done; returns the coordinator's message."""
        return self._done(self._call(ReleaseTransport, transport_id=transport))

    def set_mode(self, robot: int, mode: str) -> str:
        """Sets a robot's mode by its name; returns the coordinator's message."""
        return self._done(self._call(SetRobotMode, kiva_id=robot, mode=_MODES[mode]))

    def tow(self, robot: int) -> str:
        """Moves a broken robot to where it is in no robot's way; returns the answer's message."""
        return self._done(self._call(Tow, kiva_id=robot))

    def close_zone(
        self,
        corners: tuple[float, float, float, float],
        duration: float,
        reason: str,
        by: str,
        check: bool,
    ) -> tuple[int, list[str]]:
        """Closes a zone, x1 y1 x2 y2 [m], for a duration [s], or checks what that would do. Returns
        its number, 0 for none, and what waits for it."""
        fields = dict(zip(("x1", "y1", "x2", "y2"), corners))
        answer = self._call(
            CloseZone, **fields, duration=duration, reason=reason, by=by, check=check
        )
        self._done(answer)
        return answer.zone_id, list(answer.waits)

    def open_zone(self, zone: int, by: str) -> str:
        """Opens a zone; returns the coordinator's message."""
        return self._done(self._call(OpenZone, zone_id=zone, by=by))

    def _call(self, kind: type, **fields: Any) -> Any:
        if not self.runs():
            raise RefusedError(NONE_RUNS)
        return request(self._ros, SERVICES[kind], kind, fields)

    def _done(self, answer: Any) -> str:
        if not answer.success:
            raise RefusedError(answer.message)
        return answer.message
