# SPDX-License-Identifier: Apache-2.0
"""Faults on demand as a node is asked for them: by its service, and by a script."""

import time
from pathlib import Path
from queue import Empty, SimpleQueue

import rospy

from warehouse_client.command_services import CommandServices
from warehouse_msgs.srv import Vda5050Fault, Vda5050FaultRequest, Vda5050FaultResponse
from warehouse_vda5050.faults import script
from warehouse_vda5050.faults.kinds import FaultError, FaultRequest, read_request
from warehouse_vda5050.faults.script import FaultScript
from warehouse_vda5050.vehicles import Vehicles


def read_script(file: str) -> FaultScript | None:
    """Returns the script in a file, None for ''. Raises ScriptError."""
    return script.read(Path(file).expanduser()) if file else None


class FaultDesk:
    """Serves /warehouse/vda5050_fault for some vehicles, and runs a script; update() alone touches
    the vehicles, since requests come in threads of rospy."""

    def __init__(self, vehicles: Vehicles, script: FaultScript | None) -> None:
        self._vehicles, self._script = vehicles, script
        self._begin = 0.0  # of the script, 0 before
        self._requests: SimpleQueue[tuple[int, FaultRequest]] = SimpleQueue()
        CommandServices(rospy).serve("warehouse/vda5050_fault", Vda5050Fault, self._serve)

    def _serve(self, request: Vda5050FaultRequest) -> Vda5050FaultResponse:
        number = request.kiva_id
        try:
            fault = read_request(request.fault, request.seconds)
            self._vehicles.check(number)
        except FaultError as error:
            return Vda5050FaultResponse(False, str(error))
        self._requests.put((number, fault))
        return Vda5050FaultResponse(True, "")

    def update(self) -> None:
        """Begins the faults that were asked for, and those of the script that are due."""
        try:
            while True:
                self._begin_fault(*self._requests.get_nowait())
        except Empty:
            pass
        if self._script and self._vehicles.links:
            self._begin = self._begin or time.monotonic()
            for fault in self._script.due(time.monotonic() - self._begin):
                self._begin_fault(fault.vehicle, fault.request, f"{fault.where}: ")

    def _begin_fault(self, kiva_id: int, request: FaultRequest, where: str = "") -> None:
        try:
            self._vehicles.begin_fault(kiva_id, request)
        except FaultError as error:
            rospy.logwarn(f"{where}{error}")
