# SPDX-License-Identifier: Apache-2.0
"""The warehouse at a glance: one message with every robot's status and every unit's carrier."""

from types import ModuleType
from typing import Any

from geometry_msgs.msg import Pose2D
from rospy.numpy_msg import numpy_msg
from std_msgs.msg import Header

from warehouse_client import identity, tracking
from warehouse_client.commands import COMMANDS
from warehouse_client.floor_reader import FloorReader
from warehouse_client.latest import LatestMessages, LazyPublisher
from warehouse_msgs.msg import (
    FleetState,
    KivaStatus,
    Scenery,
    UnitStates,
    WarehouseObjects,
    WarehouseState,
)

PERIOD = 1.0  # [s, simulated]


def statuses(fleet: FleetState) -> list[KivaStatus]:
    """Returns the KivaStatus of every robot in a FleetState."""
    header = Header(stamp=fleet.stamp, frame_id="world")
    poses = map(Pose2D, fleet.x, fleet.y, fleet.yaw)
    columns = (fleet.kiva_id, fleet.status, fleet.state, fleet.shelf_id, poses)
    return [KivaStatus(header, *robot) for robot in zip(*columns)]


def glance(
    fleet: FleetState | None, objects: WarehouseObjects, states: UnitStates
) -> WarehouseState:
    """Returns a WarehouseState without name and id; `fleet` is None until robots have reported."""
    units = tracking.storage_units(objects, states)
    stamp = max([states.header.stamp] + ([fleet.stamp] if fleet else []))
    return WarehouseState(
        header=Header(stamp=stamp, frame_id="world"),
        robots=len(objects.kiva_id),
        items=len(objects.items),
        shelves=len(objects.storage_units),
        belts=len(objects.belts),
        kivas=statuses(fleet) if fleet else [],
        storage_units=[units.message(i) for i in range(len(units.names))],
    )


class StatePublisher:
    """Publishes /warehouse/state. `ros` is rospy."""

    def __init__(self, ros: ModuleType) -> None:
        self._ros = ros
        self._shown: tuple[int, tuple[str, int]] | None = (
            None  # (revision, (name, id)) of the last message
        )
        self._next: float | None = None  # next time to publish [s, simulated]
        self._newest = LatestMessages(
            ros,
            fleet=("warehouse/fleet", FleetState),
            objects=("warehouse/objects", numpy_msg(WarehouseObjects)),
            states=("warehouse/unit_states", numpy_msg(UnitStates)),
            scenery=("warehouse/scenery", Scenery),
        )
        self._floor = FloorReader(ros)
        self._topic = LazyPublisher(ros, "warehouse/state", WarehouseState, self.message)

    def message(self) -> WarehouseState | None:
        """Returns the newest WarehouseState; None before the first messages."""
        if not self._newest.units_and_objects:
            return None
        out = glance(self._newest["fleet"], *self._newest.units_and_objects)
        out.warehouse_name, out.warehouse_id = identity.read(self._ros)
        out.stations = self._floor.stations
        out.place_x, out.place_y = self._floor.places
        return out

    def turn(self, patience: float = 1.0) -> None:
        """Waits at most `patience` [s, wall] for new messages, and publishes the state when
        it has changed, and once a PERIOD."""
        news = self._newest.wait(patience)
        fit = self._newest.units_and_objects
        if not fit:
            return
        fleet = self._newest["fleet"]  # comes several times a second, even without robots
        now = fleet.stamp.to_sec() if fleet else 0.0
        new_floor = self._floor.take(self._newest["scenery"])
        # The name is read in quiet moments; it is the last step of building a warehouse.
        shown = (fit[0].revision, None if news else identity.read(self._ros))
        due = self._next is None or not self._next - PERIOD <= now < self._next
        if due or new_floor or self._differs(shown):
            self._topic.publish()
            self._shown, self._next = (shown[0], identity.read(self._ros)), now + PERIOD

    def _differs(self, shown: tuple[Any, Any]) -> bool:
        revision, name = shown
        return (
            self._shown is None or revision != self._shown[0] or name not in (None, self._shown[1])
        )


def follow(ros: ModuleType) -> None:
    """Publishes until shutdown: the body of create_warehouse_topics."""
    for topic, kind in COMMANDS.items():
        ros.Publisher(topic, kind, queue_size=10)
    publisher = StatePublisher(ros)
    while not ros.is_shutdown():
        publisher.turn()
