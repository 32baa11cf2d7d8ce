# SPDX-License-Identifier: Apache-2.0
"""What the vehicle core adds to a driver's factsheet: its actions, and what orders may hold."""

from dataclasses import replace

from warehouse_vda5050.field_rules import TABLE, Use
from warehouse_vda5050.model import BlockingType, Factsheet, SupportedAction
from warehouse_vda5050.zones.store import MAX_ZONES, SUPPORTED
from warehouse_vda5050.zones.zone import ZoneType

ANY: tuple[BlockingType, ...] = (*BlockingType,)
LIFTING = (
    ("loadId", "STRING", True, "the number of the unit; left out: whichever is there"),
    ("stationName", "STRING", True, "any; the node says where"),
    ("stationType", "STRING", True, "any; the node says where"),
    ("loadType", "STRING", True, "that of loadSets"),
    ("lhd", "STRING", True, "lift"),
    ("height", "NUMBER", True, "0"),
    ("depth", "NUMBER", True, "0"),
    ("side", "STRING", True, "left empty: it lifts from below"),
)


def _at_node(
    type: str, text: str, parameters: tuple[tuple[str, str, bool, str], ...] = ()
) -> SupportedAction:
    """A lift that has begun is completed; it stands still while the robot is paused."""
    return SupportedAction(type, ("NODE",), text, parameters, ANY, can_pause=bool(parameters))


def _instant(type: str, text: str, *parameters: tuple[str, str, bool, str]) -> SupportedAction:
    return SupportedAction(type, ("INSTANT",), text, parameters)


ACTIONS = (
    _at_node("pick", "lifts the unit that stands at the node; one lift at a time", LIFTING),
    _at_node("drop", "puts the unit down at the node; one lift at a time", LIFTING),
    SupportedAction(
        "waitForTrigger", ("NODE",), "waits for the instant action trigger", (), ANY, True, True
    ),
    SupportedAction("startCharging", ("NODE", "INSTANT"), "where a charger is", (), ANY),
    SupportedAction("stopCharging", ("NODE", "INSTANT"), "of robots that can", (), ANY),
    _instant("trigger", "ends waitForTrigger"),
    _instant(
        "cancelOrder",
        "stops at the next grid point; a lift is completed",
        ("orderId", "STRING", True, "the order that is meant; left out: whichever is under way"),
    ),
    _instant("startPause", "stops as hard as the robot can"),
    _instant("stopPause", "goes on with what was paused"),
    _instant(
        "initPosition",
        "sets the position of the robot",
        ("x", "NUMBER", False, "m"),
        ("y", "NUMBER", False, "m"),
        ("theta", "NUMBER", False, "rad"),
        ("mapId", "STRING", False, "that of the floor"),
        ("lastNodeId", "STRING", True, "any; the position says which"),
    ),
    _instant(
        "retry",
        "begins an action again that is RETRIABLE",
        ("actionId", "STRING", False, "of that action"),
    ),
    _instant(
        "skipRetry",
        "ends an action that is RETRIABLE: FAILED",
        ("actionId", "STRING", False, "of that action"),
    ),
    _instant("clearInstantActions", "forgets the states of instant actions that are over"),
    _instant("stateRequest", "sends a state"),
    _instant("factsheetRequest", "sends this factsheet"),
    _instant(
        "logReport",
        "stores what happened last; resultDescription names the file",
        ("reason", "STRING", True, "written into the report"),
    ),
)
REFUSED = (
    "Refused: nodes off the grid, edges that are not along one axis of it, actions at edges."
    " trajectory and corridor are refused as well."
)
PARAMETERS = (
    ("order.nodes.nodePosition", "SUPPORTED", f"or a nodeId c<column>_<row>. {REFUSED}"),
    ("order.nodes.actions", "SUPPORTED", "pick and drop at the end of what is driven at once"),
    *(
        (f"{where}.{rule.name}", "SUPPORTED", f"{rule.use.value}: {rule.text}")
        for where in ("order.nodes.nodePosition", "order.edges")
        for rule in TABLE[where]
        if rule.is_optional and rule.use in (Use.DRIVEN, Use.CHECKED)
    ),
)


def _without_speeds(parameter: tuple[str, str, str]) -> tuple[str, str, str]:
    name, support, text = parameter
    if name != "order.edges.maxSpeed":
        return parameter
    return name, support, "checked: refused below the robot's own top speed"


ZONE_ACTIONS = (
    _instant(
        "enableZoneSet",
        "lets the zones of a set hold, and no other set's",
        ("zoneSetId", "STRING", False, "a set that was sent by zoneSet"),
    ),
    _instant(
        "deleteZoneSet",
        "forgets a zone set that is DISABLED",
        ("zoneSetId", "STRING", False, "of that set"),
    ),
)


def completed(sheet: Factsheet, zones: bool = False, keeps_speeds: bool = False) -> Factsheet:
    """Returns a driver's factsheet with what the core can; zones: whether it takes zone sets.
    keeps_speeds: whether the driver slows down for speed limits."""
    parameters = PARAMETERS if keeps_speeds else tuple(map(_without_speeds, PARAMETERS))
    sheet = replace(sheet, actions=ACTIONS, parameters=parameters, keeps_speeds=keeps_speeds)
    if not zones:
        return sheet
    kinds = [kind for kind in SUPPORTED if keeps_speeds or kind is not ZoneType.SPEED_LIMIT]
    actions, types = (*ACTIONS, *ZONE_ACTIONS), tuple(kind.value for kind in kinds)
    return replace(sheet, actions=actions, zone_types=types, max_zones=MAX_ZONES)
