# SPDX-License-Identifier: Apache-2.0
"""Robots, storage units, items and the warehouse, as the HTTP API shows them."""

import json
from collections.abc import Collection, Iterable, Sequence
from itertools import islice
from typing import Any

import numpy as np

from warehouse_client import tracking
from warehouse_client.message_names import EVENT, STATE, STATUS, failures_of
from warehouse_client.tracking import Tracked
from warehouse_layout.models.models import kind_and_number
from warehouse_msgs.msg import (
    CoordinatorState,
    Event,
    FleetState,
    UnitStates,
    Vda5050,
    WarehouseObjects,
)
from warehouse_msgs.srv import Vda5050SeenResponse
from warehouse_viewer.api.schemas.fleet import (
    Coordinator,
    RobotsByActivity,
    RobotsByMode,
    RobotsByWork,
    TransportCounts,
    Waiting,
)
from warehouse_viewer.api.schemas.models import Pose, Robot, Thing
from warehouse_viewer.api.schemas.pydantic_versions import as_json, names_of
from warehouse_viewer.api.schemas.vda5050 import Vda5050Robot, Vda5050Vehicle
from warehouse_viewer.page.activities import Activity, activity, shown_status, wait_too_long

CONNECTIONS = ("ONLINE", "OFFLINE", "CONNECTIONBROKEN")  # as Vda5050 counts them


def robots(fleet: FleetState, waiting: Collection[int] = ()) -> list[Robot]:
    """Returns a Robot for each one in a FleetState; `waiting` are the numbers of those that wait
    for too long."""
    status, does = shown_status(fleet), activity(fleet, waiting)
    state, last_end = bytes(fleet.state), bytes(fleet.last_end)
    return [
        Robot(
            name=f"kiva{number}",
            id=number,
            status=STATUS[status[i]],
            activity=Activity(does[i]).name,
            state=STATE[state[i]],
            last_end=EVENT[last_end[i]] if last_end[i] else "",
            x=fleet.x[i],
            y=fleet.y[i],
            yaw=fleet.yaw[i],
            storage_unit=f"storage_unit{fleet.shelf_id[i]}" if fleet.shelf_id[i] else "",
            charge=fleet.charge[i],
            failures=failures_of(fleet.failures[i]),
        )
        for i, number in enumerate(map(int, fleet.kiva_id))
    ]


def coordinator(state: CoordinatorState, fleet: FleetState | None = None) -> Coordinator:
    """Returns a CoordinatorState as the API describes it, with the activities of a fleet if there
    is one."""
    waiting = zip(state.waiting_kiva, state.waiting_for, state.waiting_since, state.waiting_text)
    return Coordinator(
        time=state.header.stamp.to_sec(),
        robots={name: getattr(state, name) for name in names_of(RobotsByMode)},
        work={name: getattr(state, name) for name in names_of(RobotsByWork)},
        activities=activities(fleet, wait_too_long(state)) if fleet else None,
        transports={name: getattr(state, name) for name in names_of(TransportCounts)},
        manual=list(state.manual_kiva),
        out_of_service=list(state.out_of_service_kiva),
        plan_p50=state.plan_p50,
        plan_p99=state.plan_p99,
        executed_over_planned=state.executed_over_planned,
        queues=dict(zip(state.station, state.queue)),
        waiting=[Waiting(robot=r, waits_for=f, since=s, text=t) for r, f, s, t in waiting],
        collisions=state.collisions,
        blocked=state.blocked,
        watchdog=state.watchdog,
        alarms=list(state.alarms),
    )


def activities(fleet: FleetState, waiting: Collection[int] = ()) -> RobotsByActivity:
    """Returns how many robots do what at a glance; `waiting` as for robots()."""
    counts = np.bincount(activity(fleet, waiting), minlength=len(Activity)).tolist()
    return RobotsByActivity(**{does.name.lower(): counts[does] for does in Activity})


def at_broker(message: Vda5050) -> list[Vda5050Robot]:
    """Returns the robots of a Vda5050 message as the API describes them."""
    by = ("OUTSIDE_MASTER", "COORDINATOR")[message.direction]
    planned = _parted(message.planned_points, zip(message.planned_x, message.planned_y))
    waypoints = zip(message.waypoint_x, message.waypoint_y, message.waypoint_time)
    reached = _parted(message.waypoints, waypoints)
    return [
        Vda5050Robot(
            id=number,
            driven_by=by,
            manufacturer=message.manufacturer[i],
            serial=message.serial[i],
            broker=message.broker,
            connection=CONNECTIONS[bytes(message.connection)[i]],
            driven=message.driven[i],
            order=message.order[i],
            errors=message.errors[i].splitlines(),
            faults=message.faults[i].split(", ") if message.faults[i] else [],
            planned_path=planned[i],
            intermediate_path=[{"x": x, "y": y, "time": time} for x, y, time in reached[i]],
        )
        for i, number in enumerate(message.kiva_id)
    ]


def _parted(counts: Sequence[int], rows: Iterable[Any]) -> list[list[Any]]:
    """Returns rows as lists of those lengths."""
    left = iter(rows)
    return [list(islice(left, count)) for count in counts]


def seen_at_broker(answer: Vda5050SeenResponse) -> list[Vda5050Vehicle]:
    """Returns the vehicles of an answer of the master as the API describes them."""
    return [
        Vda5050Vehicle(
            manufacturer=answer.manufacturer[i],
            serial=answer.serial[i],
            id=number or None,
            connection=CONNECTIONS[bytes(answer.connection)[i]],
            mode=answer.mode[i],
            position=[answer.x[i], answer.y[i], answer.theta[i]] if answer.placed[i] else None,
            map_id=answer.map_id[i],
            last_node=answer.last_node[i],
            factsheet=answer.factsheet[i],
            abilities=answer.abilities[i].splitlines(),
            misfits=answer.misfits[i].splitlines(),
        )
        for i, number in enumerate(answer.kiva_id)
    ]


def plain_coordinator(state: CoordinatorState, fleet: FleetState | None = None) -> dict[str, Any]:
    """Returns a CoordinatorState as JSON; `fleet` as for coordinator()."""
    return json.loads(as_json(coordinator(state, fleet)))


def things(kind: str, objects: WarehouseObjects, states: UnitStates) -> Tracked:
    """Returns where all "storage_units" or "items", as `kind` says, are."""
    return getattr(tracking, kind)(objects, states)


def find(tracked: Tracked, text: str = "", unit: str = "") -> list[int]:
    """Returns the indices of those whose name contains `text` and, if given, that lie on `unit`."""
    return [
        i
        for i, name in enumerate(tracked.names)
        if text in name and (not unit or tracked.unit[i] == unit)
    ]


def thing(tracked: Tracked, i: int) -> Thing:
    """Returns the i-th of them as a Thing."""
    carrier = tracked.carrier[i]
    return Thing(
        name=tracked.names[i],
        id=kind_and_number(tracked.names[i])[1],
        pose=dict(zip(names_of(Pose), np.asarray(tracked.pose[i]).tolist())),
        storage_unit=tracked.unit[i],
        carrier=f"kiva{carrier}" if carrier else "",
    )


def event(message: Event) -> dict[str, Any]:
    """Returns an Event as the journal keeps it, without its id."""
    return {
        "time": round(message.header.stamp.to_sec(), 3),
        "kind": EVENT.get(message.kind, str(message.kind)),
        "command": message.command,
        "model": message.model,
        "other": message.other,
        "text": message.text,
    }
