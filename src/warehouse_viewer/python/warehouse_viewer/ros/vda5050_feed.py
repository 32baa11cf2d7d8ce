# SPDX-License-Identifier: Apache-2.0
"""The robots at a broker by VDA 5050, as the nodes there publish them; faults on demand."""

import math
import time
from types import ModuleType
from typing import Any

from warehouse_client.message_check import subscribe
from warehouse_msgs.msg import Vda5050
from warehouse_msgs.srv import (
    Vda5050Fault,
    Vda5050Onboard,
    Vda5050Remove,
    Vda5050Seen,
    Vda5050SeenResponse,
)
from warehouse_viewer.page.source import RefusedError
from warehouse_viewer.ros.simulation import is_offered, request

FAULT = "warehouse/vda5050_fault"
ONBOARD, REMOVE = "warehouse/vda5050_onboard", "warehouse/vda5050_remove"
SEEN = "warehouse/vda5050_seen"
SETTLES = 1.0  # a latched message may come before its connection counts as one [s]


class Vda5050Feed:
    """The newest message of each direction; none once no node publishes. `ros` is rospy."""

    def __init__(self, ros: ModuleType) -> None:
        self._ros = ros
        self._newest: dict[int, Vda5050] = {}
        self._kept_at = -math.inf  # when a message came last
        self._subscriber = subscribe(ros, "warehouse/vda5050", Vda5050, self._keep, queue_size=10)

    def _keep(self, message: Vda5050) -> None:
        self._kept_at = time.monotonic()
        self._newest[message.direction] = message

    @property
    def messages(self) -> list[Vda5050]:
        """The latest message of each direction."""
        if self._subscriber.get_num_connections():
            return [*self._newest.values()]
        if time.monotonic() > self._kept_at + SETTLES:
            self._newest.clear()
        return []

    def is_driven(self, number: int) -> bool:
        """Returns whether a robot is a vehicle that the master of this warehouse drives."""
        masters = (m for m in self.messages if m.direction == Vda5050.MASTER)
        return any(number in message.kiva_id for message in masters)

    def begin_fault(self, number: int, fault: str, seconds: float) -> None:
        """Lets a vehicle misbehave; '' ends that. Blocks. Raises RefusedError, AwayError."""
        if not is_offered(self._ros, FAULT):
            raise RefusedError("no robot is a vehicle: start vehicles.launch")
        fields = {"kiva_id": number, "fault": fault, "seconds": seconds}
        answer = request(self._ros, FAULT, Vda5050Fault, fields)
        if not answer.success:
            raise RefusedError(answer.message)

    def seen(self) -> Vda5050SeenResponse:
        """Returns the vehicles at the broker. Blocks. Raises RefusedError, AwayError."""
        return self._ask_master(SEEN, Vda5050Seen, {})

    def onboard(self, fields: dict[str, Any]) -> tuple[int, str]:
        """Makes a vehicle a robot, by the fields of Vda5050Onboard; returns its number, and what
        was done. Blocks. Raises RefusedError, AwayError."""
        answer = self._ask_master(ONBOARD, Vda5050Onboard, fields)
        if not answer.success:
            raise RefusedError(answer.message)
        return answer.kiva_id, answer.message

    def remove(self, number: int) -> str:
        """Lets a vehicle be no robot any more; returns what was done. Blocks. Raises RefusedError,
        AwayError."""
        answer = self._ask_master(REMOVE, Vda5050Remove, {"kiva_id": number})
        if not answer.success:
            raise RefusedError(answer.message)
        return answer.message

    def _ask_master(self, name: str, kind: type, fields: dict[str, Any]) -> Any:
        if not is_offered(self._ros, name):
            raise RefusedError("no master of VDA 5050 runs: start master.launch")
        return request(self._ros, name, kind, fields)
