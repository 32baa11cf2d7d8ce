# SPDX-License-Identifier: Apache-2.0
"""Robots and vehicles at a broker, by VDA 5050: what they do, faults, adding and removing."""

import math

from fastapi import APIRouter

from warehouse_msgs.msg import Vda5050
from warehouse_viewer.api import catalogue
from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.routes.common import NUMBER, SENT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.fleet import NewFault
from warehouse_viewer.api.schemas.vda5050 import (
    NewVehicle,
    Vda5050Robot,
    Vda5050Vehicles,
    VehicleNumber,
)

router = APIRouter()


@router.get("/vda5050", response_model=list[Vda5050Robot], responses=problems())
async def get_vda5050(backend: ApiBackend = BACKEND) -> object:
    """Robots at a broker by VDA 5050: whose they are, connection, order, errors, planned path."""
    return [
        robot for message in backend.feed.vda5050.messages for robot in catalogue.at_broker(message)
    ]


@router.get("/vda5050/vehicles", response_model=Vda5050Vehicles, responses=problems(409))
async def get_vehicles(backend: ApiBackend = BACKEND) -> object:
    """All vehicles that the master has seen at its broker: what each can, and what does not fit
    this warehouse."""
    feed = backend.feed.vda5050
    if not any(message.direction == Vda5050.MASTER for message in feed.messages):
        return {"runs": False, "broker": "", "vehicles": []}
    answer = await backend.call(feed.seen)
    vehicles = catalogue.seen_at_broker(answer)
    return {"runs": True, "broker": answer.broker, "vehicles": vehicles}


@router.post(
    "/vda5050/vehicles", status_code=201, response_model=VehicleNumber, responses=problems(*SENT)
)
async def add_vehicle(body: NewVehicle, backend: ApiBackend = BACKEND) -> object:
    """Makes a vehicle at the broker a robot of this warehouse: the coordinator drives it as long
    as it takes orders. A master that is restarted knows it."""
    number, message = await backend.call(
        backend.feed.vda5050.onboard,
        {
            "manufacturer": body.manufacturer,
            "serial": body.serial,
            "kiva_id": body.id,
            "place": ("STANDS", "ORIGIN").index(body.place),
            "x": body.x,
            "y": body.y,
            "theta": math.remainder(body.heading, math.tau),
            "map_id": body.map_id,
            "node_ids": body.node_ids,
            "action_parameters": body.action_parameters,
            "assume": body.assume,
        },
    )
    return {"id": number, "message": message}


@router.delete("/vda5050/vehicles/{number}", response_model=Done, responses=problems(409))
async def remove_vehicle(number: int = NUMBER, backend: ApiBackend = BACKEND) -> object:
    """Lets a vehicle be no robot of this warehouse any more. It has to be idle and unloaded."""
    return {"message": await backend.call(backend.feed.vda5050.remove, number)}


@router.post("/vda5050/{number}/faults", response_model=Done, responses=problems(404, *SENT))
async def begin_fault(
    body: NewFault, number: int = NUMBER, backend: ApiBackend = BACKEND
) -> object:
    """Lets a robot that is a vehicle misbehave, by which an outside master is tried: its states are
    lost, it jumps, it refuses orders. What the robot does is in the events."""
    await backend.robot(number)
    await backend.call(backend.feed.vda5050.begin_fault, number, body.fault, body.seconds)
    return {"message": f"kiva{number}: {body.fault or 'no fault'}"}
