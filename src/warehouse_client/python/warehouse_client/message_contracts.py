# SPDX-License-Identifier: Apache-2.0
"""The contracts of messages: constraints on their fields beyond their types.

Numbers are finite unless a contract says otherwise, in messages of other packages as well.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from warehouse_client import message_names
from warehouse_layout.models.models import KINDS
from warehouse_msgs.msg import (
    ClosedZones,
    Event,
    Look,
    OrderEvent,
    OrderStatus,
    Station,
    StationState,
    Vda5050,
)

Kinds = Mapping[Any, str]  # the values that a message defines, and their names


@dataclass(frozen=True)
class Contract:
    """The contract of a message type.

    tables: fields that are columns of one table, "carrier pose:7" for a pose of 7 numbers a row.
    optional: columns that may also be empty. kinds: the values of fields with named values. ids:
    fields of numbers above 0 without repetition. indices: (lowest, field) into which a field's
    values are indices. names: the prefix of the names in a field, before their number. totals: the
    fields whose sum is the length of a field. positive: fields of numbers above 0. any_number:
    fields in which infinity and NaN have a meaning. source: the only node that is accepted while it
    publishes, besides those of `beside`; "": any node.
    """

    tables: Sequence[str] = ()
    optional: frozenset[str] = frozenset()
    kinds: Mapping[str, Kinds] = field(default_factory=dict)
    ids: frozenset[str] = frozenset()
    indices: Mapping[str, tuple[int, str]] = field(default_factory=dict)
    names: Mapping[str, str] = field(default_factory=dict)
    totals: Mapping[str, Sequence[str]] = field(default_factory=dict)
    positive: frozenset[str] = frozenset()
    any_number: frozenset[str] = frozenset()
    source: str = ""
    beside: frozenset[str] = frozenset()


def _words(*names: str) -> Kinds:
    return {name: name for name in names}


_STATION = _words(Station.PICK, Station.REPLENISH)
_KIVA = {"status": message_names.STATUS, "state": message_names.STATE}
_ENDS = {0: "none yet", Event.DONE: "DONE", Event.BLOCKED: "BLOCKED"}
_DOING = _words(*message_names.WORK, "manual", "out_of_service")
_, _UNIT, _ITEM, _BELT = KINDS
_WORLD, _FLEET, _SHIFT = "gazebo", "coordinator", "operations"  # nodes

_WAREHOUSE = {
    "ClosedZones": Contract(
        source=_FLEET,
        tables=(
            "transport_id shelf_id why",
            "event_id event_time event_kind event_by event_text",
        ),
        kinds={"event_kind": message_names.constants(ClosedZones)},
    ),
    "CoordinatorPaths": Contract(
        source=_FLEET,
        tables=("kiva_id released planned waits_for goal_x goal_y", "x y"),
        ids=frozenset({"kiva_id"}),
        totals={"x": ("released", "planned")},
        any_number=frozenset({"goal_x", "goal_y"}),
    ),
    "CoordinatorState": Contract(
        source=_FLEET,
        tables=(
            "station queue",
            "waiting_kiva waiting_for waiting_since waiting_text",
            "doing_kiva doing",
        ),
        kinds={"doing": _DOING},
    ),
    # Robots behind a broker have events from the nodes of VDA 5050, too.
    "Event": Contract(
        source=_WORLD,
        beside=frozenset({"vda5050_master", "vda5050_vehicles"}),
        kinds={"kind": message_names.EVENT},
    ),
    "FleetFollow": Contract(
        tables=("kiva_id path_id first points released", "x y"), totals={"x": ("points",)}
    ),
    "FleetPaths": Contract(
        source=_WORLD, tables=("kiva_id points", "x y"), totals={"x": ("points",)}
    ),
    "FleetState": Contract(
        source=_WORLD,
        tables=(
            "kiva_id x y yaw vx vy yaw_rate status state shelf_id path_id reached left last_end"
            " failures charge load_limit mode",
        ),
        optional=frozenset({"load_limit"}),
        kinds=_KIVA | {"last_end": _ENDS, "mode": message_names.MODE},
        ids=frozenset({"kiva_id"}),
        any_number=frozenset({"load_limit"}),
    ),
    "FollowPath": Contract(tables=("x y",)),
    "ForecastResult": Contract(
        source=_SHIFT,
        tables=(
            "time done_p10 done_p50 done_p90 open_p10 open_p50 open_p90 late_p10 late_p50 late_p90"
            " pieces_per_hour_p10 pieces_per_hour_p50 pieces_per_hour_p90",
        ),
        any_number=frozenset({"finish_p10", "finish_p50", "finish_p90"}),
    ),
    "HeatMap": Contract(
        source=_SHIFT, tables=("traffic waiting",), positive=frozenset({"spacing", "width"})
    ),
    "Kpis": Contract(source=_SHIFT),
    "KivaStatus": Contract(source=_WORLD, kinds=_KIVA),
    "Look": Contract(
        tables=(
            "links link_pose:7",
            "shape_link shape_kind shape_pose:7 shape_size:3 shape_colour:4",
        ),
        kinds={"shape_kind": message_names.constants(Look)},
        indices={"shape_link": (0, "links")},
    ),
    "Notices": Contract(source=_SHIFT),
    "OrderEvent": Contract(source=_SHIFT, kinds={"kind": message_names.constants(OrderEvent)}),
    "OrderStatus": Contract(
        tables=("lines picked",), kinds={"state": message_names.constants(OrderStatus)}
    ),
    "OrderStatuses": Contract(source=_SHIFT),
    "People": Contract(source=_WORLD, tables=("name x y vx vy ahead_x ahead_y",)),
    "Scenery": Contract(
        source=_WORLD,
        tables=("models model_look pose:7",),
        indices={
            "kiva_look": (-1, "looks"),
            "storage_unit_look": (-1, "looks"),
            "item_look": (-1, "looks"),
            "model_look": (0, "looks"),
        },
        positive=frozenset({"grid_spacing"}),
    ),
    "Station": Contract(tables=("x y",), kinds={"kind": _STATION}, indices={"service": (0, "x")}),
    "StationState": Contract(
        kinds={"kind": _STATION, "mode": message_names.constants(StationState)},
    ),
    "StationStates": Contract(source=_SHIFT),
    "StockPlaces": Contract(source=_SHIFT),
    "Throughput": Contract(
        source=_SHIFT,
        tables=("items_picked pieces_stored orders_completed",),
        positive=frozenset({"interval"}),
    ),
    "TransportEvent": Contract(source=_FLEET, kinds={"kind": message_names.TRANSPORT}),
    "UnitStates": Contract(source=_WORLD, tables=("carrier pose:7", "loose_item loose_pose:7")),
    "Vda5050": Contract(
        tables=(
            "kiva_id manufacturer serial connection order errors driven faults planned_points"
            " waypoints",
            "planned_x planned_y",
            "waypoint_x waypoint_y waypoint_time",
        ),
        totals={"planned_x": ("planned_points",), "waypoint_x": ("waypoints",)},
        kinds={
            "direction": {Vda5050.VEHICLE: "VEHICLE", Vda5050.MASTER: "MASTER"},
            "connection": {
                Vda5050.ONLINE: "ONLINE",
                Vda5050.OFFLINE: "OFFLINE",
                Vda5050.CONNECTIONBROKEN: "CONNECTIONBROKEN",
            },
        },
    ),
    "WarehouseObjects": Contract(
        source=_WORLD,
        tables=("items item_unit item_pose:7", "fallen_item fallen_from"),
        ids=frozenset({"kiva_id"}),
        indices={
            "item_unit": (-1, "storage_units"),
            "fallen_item": (0, "items"),
            "fallen_from": (0, "storage_units"),
        },
        names={"storage_units": _UNIT, "items": _ITEM, "belts": _BELT},
    ),
    "WarehouseState": Contract(tables=("place_x place_y",)),
}

_OTHERS = {
    # By REP 117 inf is no return and NaN no measurement.
    "gazebo_msgs/PerformanceMetrics": Contract(source=_WORLD),
    "sensor_msgs/LaserScan": Contract(any_number=frozenset({"ranges", "intensities"})),
}

CONTRACTS = {f"warehouse_msgs/{name}": contract for name, contract in _WAREHOUSE.items()} | _OTHERS
