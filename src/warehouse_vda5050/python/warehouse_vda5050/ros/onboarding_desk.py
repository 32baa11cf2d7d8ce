# SPDX-License-Identifier: Apache-2.0
"""The services by which people add vehicles at the broker as robots, list and remove them."""

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

import rospy

from warehouse_client.command_services import CommandServices
from warehouse_client.engine import Engine, EngineError
from warehouse_client.warehouse import WarehouseClient
from warehouse_msgs.srv import (
    Vda5050Onboard,
    Vda5050OnboardRequest,
    Vda5050OnboardResponse,
    Vda5050Remove,
    Vda5050RemoveRequest,
    Vda5050RemoveResponse,
    Vda5050Seen,
    Vda5050SeenRequest,
    Vda5050SeenResponse,
)
from warehouse_vda5050.broker_topic import CONNECTIONS
from warehouse_vda5050.master import introduction
from warehouse_vda5050.master.commands import RefusedError
from warehouse_vda5050.master.fleet import RemoteFleet
from warehouse_vda5050.master.onboarded_file import OnboardedFile
from warehouse_vda5050.master.onboarding import Floor, Request, make_robot
from warehouse_vda5050.topics import Identity, TopicError

PATIENCE = 20.0  # for the thread that has the fleet [s, wall]
Act = Callable[[RemoteFleet], Any]


class OnboardingDesk:
    """Serves for a master: `post` has its thread call a function with the fleet; `file` keeps the
    robots; `joined` and `left` are called there with the number of a robot that is added or was
    removed."""

    def __init__(
        self,
        post: Callable[[Act], None],
        file: OnboardedFile,
        warehouse: WarehouseClient,
        broker: str,
        joined: Callable[[int], None],
        left: Callable[[int], None],
    ) -> None:
        self._post, self._file, self._warehouse = post, file, warehouse
        self._broker, self._joined, self._left = broker, joined, left
        commands = CommandServices(rospy)
        commands.serve("warehouse/vda5050_onboard", Vda5050Onboard, self._on_add)
        commands.serve("warehouse/vda5050_remove", Vda5050Remove, self._on_remove)
        rospy.Service("warehouse/vda5050_seen", Vda5050Seen, self._on_list)

    # --- in threads of rospy

    def _on_add(self, request: Vda5050OnboardRequest) -> Vda5050OnboardResponse:
        try:
            number, message = self._ask(lambda fleet: self._add(fleet, request))
        except (RefusedError, OSError) as error:
            return Vda5050OnboardResponse(False, str(error), 0)
        return Vda5050OnboardResponse(True, message, number)

    def _on_remove(self, request: Vda5050RemoveRequest) -> Vda5050RemoveResponse:
        try:
            self._ask(lambda fleet: self._remove(fleet, request.kiva_id))
        except (RefusedError, EngineError, OSError) as error:
            return Vda5050RemoveResponse(False, str(error))
        return Vda5050RemoveResponse(True, f"kiva{request.kiva_id} is no robot here any more")

    def _on_list(self, _request: Vda5050SeenRequest) -> Vda5050SeenResponse:
        return self._ask(self._list)

    def _ask(self, act: Act) -> Any:
        """Returns what `act` returns in the master's thread. Raises what it raises."""
        done = threading.Event()
        answer: list[Any] = []

        def work(fleet: RemoteFleet) -> None:
            try:
                answer.append(act(fleet))
            except (RefusedError, EngineError, OSError) as error:
                answer.append(error)
            finally:
                done.set()

        self._post(work)
        if not done.wait(PATIENCE):
            raise RefusedError("the master is busy, or waits for the warehouse: ask again")
        if isinstance(answer[0], Exception):
            raise answer[0]
        return answer[0]

    # --- in the master's thread

    def _add(self, fleet: RemoteFleet, asked: Vda5050OnboardRequest) -> tuple[int, str]:
        try:
            identity = Identity(asked.manufacturer, asked.serial)
        except TopicError as error:
            raise RefusedError(str(error)) from error
        name = f"{identity.manufacturer}/{identity.serial}"
        if own := fleet.of(identity):
            raise RefusedError(f"{name} is kiva{own.robot.number} already")
        vehicle = fleet.roster.get(identity)
        if vehicle is None:
            raise RefusedError(f"{name} was never seen at {self._broker}")
        request = Request(
            asked.kiva_id,
            asked.place == Vda5050OnboardRequest.STANDS,
            (asked.x, asked.y, asked.theta),
            asked.map_id,
            asked.node_ids,
            asked.action_parameters,
            asked.assume,
        )
        robot = make_robot(request, vehicle, Floor(fleet.grid, self._places(fleet)))
        self._file.add(robot)
        fleet.add(robot, time.monotonic())
        self._joined(robot.number)
        frame = robot.frame
        origin = f"{frame.x:.2f}, {frame.y:.2f} m, {frame.theta:.2f} rad"
        text = f"{name} is kiva{robot.number}; its map begins at {origin}"
        if vehicle.sheet is None:
            text += f"; {introduction.assumed(fleet.grid.spacing)}"
        return robot.number, text

    def _places(self, fleet: RemoteFleet) -> Mapping[int, tuple[float, float]]:
        """Returns where the robots of the warehouse are, by number."""
        state = self._warehouse.fleet
        there = {} if state is None else dict(zip(state.kiva_id, zip(state.x, state.y)))
        nowhere = (1e9, 1e9)  # it has not come yet; its number is taken
        own = {v.robot.number: v.view.pose[:2] for v in fleet.vehicles if v.view.is_there}
        return {v.robot.number: nowhere for v in fleet.vehicles} | own | there

    def _remove(self, fleet: RemoteFleet, number: int) -> None:
        fleet.check_removable(number)
        with Engine(rospy) as engine:
            name = f"kiva{number}"
            if name in engine.names():
                engine.delete(name)
        self._file.remove(number)
        fleet.remove(number)
        self._left(number)

    def _list(self, fleet: RemoteFleet) -> Vda5050SeenResponse:
        answer = Vda5050SeenResponse(broker=self._broker, connection=[])
        for vehicle in fleet.roster.all():
            own, state = fleet.of(vehicle.identity), vehicle.state
            at = state.position if state else None
            parameters = own.robot.action_parameters if own else {}
            answer.manufacturer.append(vehicle.identity.manufacturer)
            answer.serial.append(vehicle.identity.serial)
            answer.kiva_id.append(own.robot.number if own else 0)
            answer.connection.append(CONNECTIONS[vehicle.connection])
            answer.mode.append(state.mode.value if state else "")
            answer.placed.append(at is not None and at.initialized)
            answer.x.append(at.x if at else 0.0)
            answer.y.append(at.y if at else 0.0)
            answer.theta.append(at.theta if at else 0.0)
            answer.map_id.append(at.map_id if at else "")
            answer.last_node.append(state.last_node if state else "")
            answer.factsheet.append(vehicle.sheet is not None)
            lines = introduction.abilities(vehicle.sheet) if vehicle.sheet else ()
            answer.abilities.append("\n".join(lines))
            lines = introduction.misfits(vehicle, parameters, fleet.grid.spacing)
            answer.misfits.append("\n".join(lines))
        return answer
