# SPDX-License-Identifier: Apache-2.0
"""Zone sets, requests and responses in the JSON of 3.0.0."""

import datetime
from typing import Any

from warehouse_vda5050.codec.base import header_json
from warehouse_vda5050.codec.orders import enum_of
from warehouse_vda5050.headers import iso
from warehouse_vda5050.model import Header, Responses, VehicleState, ZoneSet
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.fields import Fields
from warehouse_vda5050.zones.zone import (
    PARAMETERS,
    Grant,
    Parameters,
    RequestStatus,
    Response,
    Zone,
    ZoneRequest,
    ZoneSetState,
    ZoneType,
)

MAX_VERTICES = 1000


def read_zone_set(fields: Fields, header: Header) -> ZoneSet:
    """Returns a zone set. Raises MessageError."""
    inner = fields.object("zoneSet")
    if inner is None:
        raise MessageError("zoneSet is missing; an object was expected")
    inner.skip("zoneSetDescriptor")
    zones = ZoneSet(
        inner.text("zoneSetId"),
        inner.text("mapId"),
        tuple(_read_zone(zone) for zone in inner.objects("zones")),
        header,
    )
    if not zones.id:
        raise MessageError("zoneSet.zoneSetId is empty")
    inner.close()
    fields.close()
    return zones


def _read_zone(fields: Fields) -> Zone:
    fields.skip("zoneDescriptor", "entryActions", "duringActions", "exitActions")
    id, type = fields.text("zoneId"), _read_type(fields)
    vertices = tuple((v.number("x"), v.number("y")) for v in fields.objects("vertices"))
    if not 3 <= len(vertices) <= MAX_VERTICES:
        where = fields.path_of("vertices")
        raise MessageError(f"{where} has {len(vertices)}; 3 to {MAX_VERTICES} were expected")
    known = PARAMETERS.get(type, Parameters())
    number = fields.number(known.number) if known.number else 0.0
    zone = Zone(id, type, vertices, number, _read_word(fields, known) if known.word else "")
    fields.close()
    return zone


def _read_type(fields: Fields) -> ZoneType:
    fields.text("zoneType")
    kind: ZoneType = enum_of(fields, "zoneType", ZoneType, None)
    return kind


def _read_word(fields: Fields, known: Parameters) -> str:
    # Without a word a RELEASE zone has STOP (Table 6).
    default = {} if fields.strict or known.words[0] != "STOP" else {"default": "STOP"}
    word: str = fields.text(known.word, **default)
    if word not in known.words:
        names = ", ".join(known.words)
        raise MessageError(f"{fields.path_of(known.word)} is {word[:60]!r}; {names} was expected")
    return word


def zone_set_json(zones: ZoneSet) -> dict[str, Any]:
    """Returns the object of a zone set."""
    content = {
        "mapId": zones.map_id,
        "zoneSetId": zones.id,
        "zones": [_zone_json(zone) for zone in zones.zones],
    }
    return {**header_json(zones.header), "zoneSet": content}


def _zone_json(zone: Zone) -> dict[str, Any]:
    known = PARAMETERS.get(zone.type, Parameters())
    return {
        "zoneId": zone.id,
        "zoneType": zone.type.value,
        "vertices": [{"x": x, "y": y} for x, y in zone.vertices],
        **({known.number: zone.number} if known.number else {}),
        **({known.word: zone.word} if known.word else {}),
    }


def read_responses(fields: Fields, header: Header) -> Responses:
    """Returns a master's answers. Raises MessageError."""
    responses = tuple(_read_response(item) for item in fields.objects("responses"))
    fields.close()
    return Responses(responses, header)


def _read_response(fields: Fields) -> Response:
    fields.text("grantType")
    grant = enum_of(fields, "grantType", Grant, None)
    response = Response(fields.text("requestId"), grant, _read_time(fields, "leaseExpiry"))
    fields.close()
    return response


def _read_time(fields: Fields, key: str) -> float | None:
    """Returns a time [s since 1970], None for none; it is UTC where it does not say."""
    text = fields.text(key, None)
    if text is None:
        return None
    try:
        time = datetime.datetime.fromisoformat(text)
    except ValueError:
        where = fields.path_of(key)
        raise MessageError(f"{where} is {text[:60]!r}; a time of ISO 8601 was expected") from None
    return (time if time.tzinfo else time.replace(tzinfo=datetime.UTC)).timestamp()


def responses_json(message: Responses) -> dict[str, Any]:
    """Returns the object of a master's answers."""
    return {
        **header_json(message.header),
        "responses": [
            {
                "requestId": response.request,
                "grantType": response.grant.value,
                **({} if response.expiry is None else {"leaseExpiry": iso(response.expiry)}),
            }
            for response in message.responses
        ],
    }


def zones_of_state_json(state: VehicleState) -> dict[str, Any]:
    """Returns the fields of a state that are about zones."""
    status = {True: "ENABLED", False: "DISABLED"}
    return {
        "zoneSets": [
            {"zoneSetId": s.id, "mapId": s.map_id, "zoneSetStatus": status[s.enabled]}
            for s in state.zone_sets
        ],
        "zoneRequests": [
            {
                "requestId": request.id,
                "requestType": request.type,
                "zoneId": request.zone,
                "zoneSetId": request.zone_set,
                "requestStatus": request.status.value,
            }
            for request in state.zone_requests
        ],
    }


def read_zone_set_state(fields: Fields) -> ZoneSetState:
    """Returns a zone set that a vehicle has. Raises MessageError."""
    enabled = fields.text("zoneSetStatus", "").upper() == "ENABLED"
    return ZoneSetState(fields.text("zoneSetId"), fields.text("mapId", ""), enabled)


def read_zone_request(fields: Fields) -> ZoneRequest:
    """Returns a request of a vehicle. Raises MessageError."""
    return ZoneRequest(
        fields.text("requestId"),
        fields.text("zoneId"),
        fields.text("zoneSetId", ""),
        enum_of(fields, "requestStatus", RequestStatus, RequestStatus.REQUESTED),
        fields.text("requestType", "ACCESS"),
    )
