# SPDX-License-Identifier: Apache-2.0
"""The zone sets that a vehicle has, of its one map; at most one is enabled."""

import math
from collections.abc import Collection, Iterable

from warehouse_vda5050.errors import ErrorType, Predefined
from warehouse_vda5050.model import LEAST_SPEED, MAP_ID, ZoneSet
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.zones.zone import Zone, ZoneSetState, ZoneType

SUPPORTED = (
    ZoneType.BLOCKED,
    ZoneType.RELEASE,
    ZoneType.SPEED_LIMIT,
    ZoneType.DIRECTED,
    ZoneType.BIDIRECTED,
)
MAX_ZONES = 1000  # of one set
MAX_SETS = 20
Reference = tuple[str, str]


class ZoneStore:
    """Zone sets by their ids. enable() and delete() return why not, or ''. types: the types of
    zones that the vehicle keeps to."""

    def __init__(self, types: Collection[str] = SUPPORTED) -> None:
        self._types = types
        self._sets: dict[str, ZoneSet] = {}
        self.enabled: ZoneSet | None = None

    def add(self, zones: ZoneSet) -> None:
        """Adds a set, DISABLED. Raises MessageError, with nothing changed."""
        refer = (("topic", Kind.ZONE_SET.value), ("zoneSetId", zones.id[:100]))
        if zones.id in self._sets:
            text = f"zone set {zones.id[:60]!r} is there already; changed zones need another id"
            _refuse(text, refer, Predefined.DUPLICATE_ZONE_SET)
        if zones.map_id != MAP_ID:
            text = f"mapId is {zones.map_id[:60]!r}; {MAP_ID!r} was expected"
            _refuse(text, refer, Predefined.UNKNOWN_MAP_ID)
        if len(self._sets) >= MAX_SETS or len(zones.zones) > MAX_ZONES:
            text = f"{MAX_SETS} zone sets of {MAX_ZONES} zones are the most"
            _refuse(text, refer, Predefined.INSUFFICIENT_MEMORY)
        _check_zones(zones.zones, refer, self._types)
        self._sets[zones.id] = zones

    def enable(self, id: str) -> str:
        """Enables a set, and disables the other ones of the map."""
        if id not in self._sets:
            return self._unknown(id)
        self.enabled = self._sets[id]
        return ""

    def delete(self, id: str) -> str:
        """Removes a set that is disabled."""
        if id not in self._sets:
            return self._unknown(id)
        if self.enabled is self._sets[id]:
            return f"zone set {id[:60]!r} is enabled; another has to be enabled first"
        del self._sets[id]
        return ""

    def _unknown(self, id: str) -> str:
        return f"zone set {id[:60]!r} is unknown; sent were {', '.join(self._sets) or 'none'}"

    def states(self) -> tuple[ZoneSetState, ...]:
        """Returns the states of all."""
        return tuple(
            ZoneSetState(zones.id, zones.map_id, zones is self.enabled)
            for zones in self._sets.values()
        )


def _check_zones(
    zones: Iterable[Zone], refer: tuple[Reference, ...], types: Collection[str]
) -> None:
    ids: set[str] = set()
    for zone in zones:
        here = (*refer, ("zoneId", zone.id[:100]))
        if not zone.id or zone.id in ids:
            text = f"zoneId {zone.id[:60]!r}; each zone needs an id of its own"
            _refuse(text, here, Predefined.VALIDATION_FAILURE)
        ids.add(zone.id)
        if zone.type not in types:
            names = ", ".join(types)
            text = f"zone {zone.id[:60]!r}: zoneType is {zone.type}; {names} are supported"
            _refuse(text, (*here, ("field", "zoneType")), Predefined.UNSUPPORTED_PARAMETER)
        if zone.type is ZoneType.SPEED_LIMIT and not LEAST_SPEED <= zone.number < math.inf:
            text = f"zone {zone.id[:60]!r}: maximumSpeed is {zone.number:g}; {LEAST_SPEED:g} m/s"
            more = (*here, ("field", "maximumSpeed"))
            _refuse(f"{text} or more was expected", more, Predefined.UNSUPPORTED_PARAMETER)
        if zone.word == "EVACUATE":
            text = f"zone {zone.id[:60]!r}: releaseLossBehavior is EVACUATE; STOP or CONTINUE was"
            more = (*here, ("field", "releaseLossBehavior"))
            _refuse(f"{text} expected", more, Predefined.UNSUPPORTED_PARAMETER)


def _refuse(text: str, refer: tuple[Reference, ...], precise: Predefined) -> None:
    raise MessageError(text, ErrorType.VALIDATION.value, refer, precise)
