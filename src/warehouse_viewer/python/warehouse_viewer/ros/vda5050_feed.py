# SPDX-License-Identifier: Apache-2.0
"""The robots at a broker by VDA 5050, as the nodes there publish them; faults on demand."""

from types import ModuleType

from warehouse_client.message_check import subscribe
from warehouse_msgs.msg import Vda5050
from warehouse_msgs.srv import Vda5050Fault
from warehouse_viewer.page.source import RefusedError
from warehouse_viewer.ros.simulation import is_offered, request

FAULT = "warehouse/vda5050_fault"


class Vda5050Feed:
    """The newest message of each direction; none once no node publishes. `ros` is rospy."""

    def __init__(self, ros: ModuleType) -> None:
        self._ros = ros
        self._newest: dict[int, Vda5050] = {}
        self._subscriber = subscribe(ros, "warehouse/vda5050", Vda5050, self._keep, queue_size=10)

    def _keep(self, message: Vda5050) -> None:
        self._newest[message.direction] = message

    @property
    def messages(self) -> list[Vda5050]:
        """The latest message."""
        if not self._subscriber.get_num_connections():
            self._newest.clear()
        return [*self._newest.values()]

    def begin_fault(self, number: int, fault: str, seconds: float) -> None:
        """Lets a vehicle misbehave; '' ends that. Blocks. Raises RefusedError, AwayError."""
        if not is_offered(self._ros, FAULT):
            raise RefusedError("no robot is a vehicle: start vehicles.launch")
        fields = {"kiva_id": number, "fault": fault, "seconds": seconds}
        answer = request(self._ros, FAULT, Vda5050Fault, fields)
        if not answer.success:
            raise RefusedError(answer.message)
