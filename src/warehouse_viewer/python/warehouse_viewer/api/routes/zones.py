# SPDX-License-Identifier: Apache-2.0
"""Zones of the floor that people close for a time, and open again."""

from urllib.parse import unquote

from fastapi import APIRouter, Header, Path, Query

from warehouse_viewer.api import zones_json
from warehouse_viewer.api.backend import BACKEND, ApiBackend
from warehouse_viewer.api.routes.common import SENT, problems
from warehouse_viewer.api.schemas.base import Done
from warehouse_viewer.api.schemas.zones import ClosedZones, NewZone, ZoneForecast, ZoneNumber

router = APIRouter()
ZONE = Path(ge=1, le=2**32 - 1, description="of the zone")
CORNER = Query(ge=-1e9, le=1e9, description="[m]")
BY = Header("", max_length=200, description="name of the person, percent-encoded")


@router.get("/zones", response_model=ClosedZones, responses=problems())
async def get_zones(backend: ApiBackend = BACKEND) -> object:
    """The closed zones, the robots inside, and the transports that wait for them."""
    backend.feed.subscribe(("zones", "coordinator"))
    return zones_json.zones(backend.feed.zones)


@router.get("/zones/check", response_model=ZoneForecast, responses=problems(409))
async def check_zone(
    x1: float = CORNER,
    y1: float = CORNER,
    x2: float = CORNER,
    y2: float = CORNER,
    backend: ApiBackend = BACKEND,
) -> object:
    """What would wait if a zone were closed; closes none."""
    _, waits = await backend.coordinate("close_zone", (x1, y1, x2, y2), 0.0, "check", "", True)
    return {"waits": waits}


@router.post("/zones", status_code=201, response_model=ZoneNumber, responses=problems(*SENT))
async def close_zone(body: NewZone, x_person: str = BY, backend: ApiBackend = BACKEND) -> object:
    """Closes a rectangle of the floor: the fleet's robots keep out of it, those inside leave, and
    transports into it wait."""
    corners = body.x1, body.y1, body.x2, body.y2
    by = body.by.strip() or _name(x_person)
    number, waits = await backend.coordinate(
        "close_zone", corners, body.duration, body.reason, by, False
    )
    return {"id": number, "waits": waits}


@router.delete("/zones/{number}", response_model=Done, responses=problems(409))
async def open_zone(
    number: int = ZONE, x_person: str = BY, backend: ApiBackend = BACKEND
) -> object:
    """Opens a zone before its time is over."""
    await backend.coordinate("open_zone", number, _name(x_person))
    return {"message": f"zone {number} is open again"}


def _name(header: str) -> str:
    """Returns the person's name in a header."""
    return "".join(c for c in unquote(header) if c.isprintable()).strip()[:60]
