# SPDX-License-Identifier: Apache-2.0
"""What the vehicle core adds to a driver's factsheet: its actions, and what orders may hold."""

from dataclasses import replace

from warehouse_vda5050.model import BlockingType, Factsheet, SupportedAction

ANY = (BlockingType.NONE, BlockingType.SOFT, BlockingType.HARD)
STANDING = (BlockingType.HARD,)
LOAD = ("loadId", "STRING", True, "the number of the unit; left out: whichever is there")
STATION = ("stationName", "STRING", True, "told, and not made use of")
KIND = ("loadType", "STRING", True, "told, and not made use of")


def _instant(type: str, text: str, *parameters: tuple[str, str, bool, str]) -> SupportedAction:
    return SupportedAction(type, ("INSTANT",), text, parameters)


ACTIONS = (
    SupportedAction(
        "pick", ("NODE",), "lifts the unit that stands at the node", (LOAD, STATION, KIND), STANDING
    ),
    SupportedAction(
        "drop", ("NODE",), "puts the unit down at the node", (LOAD, STATION, KIND), STANDING
    ),
    SupportedAction("waitForTrigger", ("NODE",), "waits for the instant action trigger", (), ANY),
    SupportedAction("startCharging", ("NODE", "INSTANT"), "where a charger is", (), STANDING),
    SupportedAction("stopCharging", ("NODE", "INSTANT"), "of robots that can", (), STANDING),
    _instant("trigger", "ends waitForTrigger"),
    _instant("cancelOrder", "stops at the next grid point; a lift comes to its end"),
    _instant("startPause", "stops as hard as the robot can"),
    _instant("stopPause", "goes on with what was paused"),
    _instant(
        "initPosition",
        "tells the robot where it is",
        ("x", "NUMBER", False, "m"),
        ("y", "NUMBER", False, "m"),
        ("theta", "NUMBER", False, "rad"),
        ("mapId", "STRING", False, ""),
    ),
    _instant("stateRequest", "sends a state"),
    _instant("factsheetRequest", "sends this factsheet"),
    _instant("logReport", "writes down what happened last", ("reason", "STRING", True, "")),
)
REFUSED = (
    "Refused: nodes off the grid, edges that are not along one axis of it, actions at edges."
    " trajectory and corridor are refused as well."
)
PARAMETERS = (
    ("order.nodes.nodePosition", "SUPPORTED", f"or a nodeId c<column>_<row>. {REFUSED}"),
    ("order.nodes.actions", "SUPPORTED", "pick and drop at the end of what is driven at once"),
)


def completed(sheet: Factsheet) -> Factsheet:
    """Returns a driver's factsheet with what the core can."""
    return replace(sheet, actions=ACTIONS, parameters=PARAMETERS)
