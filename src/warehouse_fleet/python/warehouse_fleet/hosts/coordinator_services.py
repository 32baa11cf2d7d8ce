# SPDX-License-Identifier: Apache-2.0
"""The services of the coordinator: requests from ROS to a FleetController."""

import math
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, Protocol

import rospy

from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import SetModelState
from warehouse_client.command_services import CommandServices
from warehouse_fleet.hosts.event_publisher import EventPublisher
from warehouse_fleet.hosts.fleet_driver import square
from warehouse_fleet.traffic.elevators import Move
from warehouse_fleet.traffic.traffic import STAYS
from warehouse_fleet.transports.towing import TowOrder
from warehouse_fleet.transports.transport_book import TransportAnswer
from warehouse_fleet.transports.transports import Transports
from warehouse_layout.message_enums import RobotMode
from warehouse_msgs.srv import (
    CancelTransport,
    CancelTransportRequest,
    CancelTransportResponse,
    ReleaseTransport,
    ReleaseTransportRequest,
    ReleaseTransportResponse,
    SetRobotMode,
    SetRobotModeRequest,
    SetRobotModeResponse,
    Tow,
    TowRequest,
    TowResponse,
    Transport,
    TransportRequest,
    TransportResponse,
)


class Host(Protocol):
    """The host of a controller to which services pass their requests."""

    controller: Any  # a FleetController, while there is a warehouse
    events: EventPublisher

    @property
    def lock(self) -> AbstractContextManager[Any, Any]:
        """The lock that is held while a request is answered."""

    @property
    def reason(self) -> str:
        """Why there is no controller."""

    def set_mode(self, kiva_id: int, mode: int) -> None:
        """Sets the side that commands a robot. Raises ValueError with the reason if it can't."""

    def yaw_of(self, kiva_id: int) -> float:
        """Returns a robot's heading [rad] by its last report."""


class CoordinatorServices:
    """Offers the services of a coordinator, the Host."""

    def __init__(self, host: Host) -> None:
        self._host = host
        self._place = rospy.ServiceProxy("gazebo/set_model_state", SetModelState)
        services = CommandServices(rospy)
        services.serve("warehouse/transport", Transport, self._on_transport)
        services.serve("warehouse/release_transport", ReleaseTransport, self._on_release)
        services.serve("warehouse/cancel_transport", CancelTransport, self._on_cancel)
        services.serve("warehouse/tow", Tow, self._on_tow)
        services.serve("warehouse/set_robot_mode", SetRobotMode, self._on_mode)

    def _on_transport(self, request: TransportRequest) -> TransportResponse:
        host = self._host
        with host.lock:
            if host.controller is None:
                return TransportResponse(*TransportAnswer(0, False, host.reason))
            answer = host.controller.transports.submit(
                request.shelf_id,
                request.station,
                request.x,
                request.y,
                request.then,
                request.priority,
            )
            if answer.accepted:
                host.events.ledger.add(answer.transport_id, request.shelf_id, request.station)
            return TransportResponse(*answer)

    def _on_release(self, request: ReleaseTransportRequest) -> ReleaseTransportResponse:
        return ReleaseTransportResponse(*self._asked(lambda t: t.release(request.transport_id)))

    def _on_cancel(self, request: CancelTransportRequest) -> CancelTransportResponse:
        return CancelTransportResponse(*self._asked(lambda t: t.cancel(request.transport_id)))

    def _asked(self, ask: Callable[[Transports], tuple[bool, str]]) -> tuple[bool, str]:
        """Returns what the fleet's transports answer, or that there is no fleet and why."""
        host = self._host
        with host.lock:
            return ask(host.controller.transports) if host.controller else (False, host.reason)

    def _on_mode(self, request: SetRobotModeRequest) -> SetRobotModeResponse:
        host = self._host
        with host.lock:
            if host.controller is None:
                return SetRobotModeResponse(False, host.reason)
            try:
                host.set_mode(request.kiva_id, request.mode)
            except ValueError as error:
                return SetRobotModeResponse(False, str(error))
            return SetRobotModeResponse(True, "")

    def _on_tow(self, request: TowRequest) -> TowResponse:
        host = self._host
        with host.lock:
            if host.controller is None:
                return TowResponse(False, host.reason)
            try:
                order = host.controller.tow(request.kiva_id)
            except ValueError as error:
                return TowResponse(False, str(error))
            traffic = host.controller.traffic
            cell = int(host.controller.plan.cell_of(order.x, order.y))
            traffic.shut(cell, traffic.time + STAYS)  # until the robot is seen there
            yaw = host.yaw_of(request.kiva_id)
        why = self.set_down(order, yaw)
        return TowResponse(not why, why)

    def set_down(self, order: TowOrder | Move, yaw: float) -> str:
        """Has the world set a robot down, with what it carries, along the axis nearest to a heading
        [rad]. Returns why it does not, or an empty text."""
        try:
            answer = self._place(_state_of(order, square(yaw)))
        except rospy.ServiceException as error:
            return str(error)
        return "" if answer.success else answer.status_message


def check_mode(mode: int) -> None:
    """Raises ValueError for a number that is not a RobotMode."""
    if mode not in list(RobotMode):
        text = f"mode is {mode}; 0 (AUTOMATIC), 1 (MANUAL) or 2 (OUT_OF_SERVICE) was expected"
        raise ValueError(text)


def _state_of(order: TowOrder | Move, yaw: float) -> ModelState:
    state = ModelState(model_name=f"kiva{order.kiva_id}", reference_frame="world")
    state.pose.position.x, state.pose.position.y = order.x, order.y
    state.pose.orientation.z = math.sin(yaw / 2)
    state.pose.orientation.w = math.cos(yaw / 2)
    return state
