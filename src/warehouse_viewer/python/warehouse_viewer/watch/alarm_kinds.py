# SPDX-License-Identifier: Apache-2.0
"""The kinds of alarms: how bad each is, how long it must last, and what a person should do."""

from typing import NamedTuple

CRITICAL, WARNING, NOTE = "critical", "warning", "note"
SEVERITIES = (CRITICAL, WARNING, NOTE)  # the worst first


class AlarmKind(NamedTuple):
    """What holds for all alarms of a kind. `after`: duration from which it counts [s];
    `remedies`: actions of causes.LABELS that may help."""

    severity: str
    title: str
    to_do: str
    after: float = 0.0
    remedies: tuple[str, ...] = ("MOMENT",)


KINDS = {
    "EMERGENCY_STOP": AlarmKind(
        CRITICAL,
        "Emergency stop",
        "No robot moves. Release the stop once the floor is clear.",
        remedies=("RELEASE", "MOMENT"),
    ),
    "ROBOT_BROKEN": AlarmKind(
        CRITICAL,
        "Robot is broken",
        "Take it out of service, repair it or have it towed, then set it automatic again.",
        remedies=("SHOW", "OUT_OF_SERVICE", "REPAIR", "TOW", "AUTOMATIC", "MOMENT"),
    ),
    "ROBOT_LOST": AlarmKind(
        CRITICAL,
        "Robot has lost its place",
        "Put it straight on a grid point, then set it automatic again.",
        remedies=("SHOW", "OUT_OF_SERVICE", "AUTOMATIC", "MOMENT"),
    ),
    "ROBOT_STALLED": AlarmKind(
        CRITICAL,
        "Robot does not move",
        "Look for what holds it. If nothing does, take it out of service and have it checked.",
        remedies=("SHOW", "OUT_OF_SERVICE", "AUTOMATIC", "MOMENT"),
    ),
    "ROBOT_BLOCKED": AlarmKind(
        CRITICAL,
        "Robot stands before an obstacle",
        "Clear its way, then give it another command or set it automatic again.",
        after=15.0,
        remedies=("SHOW", "OUT_OF_SERVICE", "AUTOMATIC", "MOMENT"),
    ),
    "UNIT_TIPPED": AlarmKind(
        CRITICAL,
        "Storage unit tipped over",
        "Close the aisle: take the robots near it out of service before anyone goes there.",
        remedies=("SHOW", "MOMENT"),
    ),
    "COLLISION": AlarmKind(
        CRITICAL,
        "Collision",
        "Look at robot and load; take the robot out of service if either is damaged.",
        remedies=("SHOW", "OUT_OF_SERVICE", "AUTOMATIC", "MOMENT"),
    ),
    "NO_COORDINATOR": AlarmKind(
        CRITICAL,
        "No coordinator answers",
        "Robots finish their last commands and stand. Restart the node `coordinator`.",
        after=10.0,
    ),
    "COORDINATOR": AlarmKind(
        CRITICAL,
        "The coordinator can't work as it should",
        "Correct what the sentence names; the rest of the floor goes on.",
    ),
    "STATION_UNATTENDED": AlarmKind(
        CRITICAL,
        "Station needs a person",
        "Send a person to the station, set it to automatic, or close it.",
        remedies=("SHOW", "STATION_AUTOMATIC", "CLOSE", "MOMENT"),
    ),
    "ITEM_FALLEN": AlarmKind(
        WARNING,
        "Item lies on the floor",
        "Pick it up: choose it on the floor page, and 'Pick up'. Its pieces are out of stock.",
        remedies=("SHOW", "PICK_UP", "MOMENT"),
    ),
    "OBSTACLE": AlarmKind(
        WARNING,
        "Something stands in the way",
        "Take away what the sentence names, or put it straight: robots go another way till then.",
        remedies=("SHOW", "MOMENT"),
    ),
    "ROBOT_WAITS": AlarmKind(
        WARNING,
        "Robot has waited for long",
        "Look on the floor what holds the first of the queue; set a manual robot automatic again.",
        remedies=("SHOW", "OUT_OF_SERVICE", "AUTOMATIC", "MOMENT"),
    ),
    "STATION_STARVED": AlarmKind(
        WARNING,
        "Station waits for storage units",
        "If robots rest, look for a jam; if none rests, the stations need more robots.",
        remedies=("SHOW", "MOMENT"),
    ),
    "ORDERS_WILL_BE_LATE": AlarmKind(
        WARNING,
        "Orders will be late",
        "Try on the page Operations, in Looking ahead, whether a station or robots more help.",
    ),
    "WATCHDOG": AlarmKind(
        WARNING,
        "Robots made no progress for 30 s",
        "The coordinator has planned again. If it recurs, look for a jam on the floor page.",
    ),
    "PLAN_REFUSED": AlarmKind(
        WARNING,
        "A plan was refused",
        "Robots keep their last plan. Report this sentence to those who look after the planner.",
    ),
    "NOTICE": AlarmKind(
        NOTE,
        "Notice of the shift",
        "Correct the order, file or station that the sentence names.",
    ),
}
