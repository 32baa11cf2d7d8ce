# SPDX-License-Identifier: Apache-2.0
"""What the remedies of alarms do: who commands a robot, repair, tow, pick up, close."""

from warehouse_msgs import srv
from warehouse_viewer.api.backend import ApiBackend
from warehouse_viewer.api.schemas.operations import MODES

FLEET = ("OUT_OF_SERVICE", "AUTOMATIC")  # modes of a robot


async def apply(backend: ApiBackend, action: str, target: str) -> str:
    """Does an action of causes.LABELS to a robot, item or station; returns the answer's message.

    Raises HTTPException where it is refused.
    """
    if action in FLEET:
        return await backend.coordinate("set_mode", _number(target), action)
    if action == "REPAIR":
        return await backend.simulate("repair", _number(target))
    if action == "TOW":
        return await backend.coordinate("tow", _number(target))
    if action == "PICK_UP":
        return await backend.simulate("pick_up", _number(target))
    if action == "RELEASE":
        return await backend.call(backend.stop.release)
    if action in ("CLOSE", "STATION_AUTOMATIC"):
        return await _set_station(backend, action, target)
    return "this is done on the page"


async def _set_station(backend: ApiBackend, action: str, name: str) -> str:
    message = await backend.call(backend.operations.latest, "stations")
    station = next((row for row in message.stations if row.name == name), None)
    mode = (
        MODES.index("AUTOMATIC") if action == "STATION_AUTOMATIC" or not station else station.mode
    )
    fields = name, action != "CLOSE", mode
    answer = await backend.call(backend.operations.call, "set_station", srv.SetStation, *fields)
    return str(answer.message)


def _number(name: str) -> int:
    return int(name.lstrip("abcdefghijklmnopqrstuvwxyz_"))
