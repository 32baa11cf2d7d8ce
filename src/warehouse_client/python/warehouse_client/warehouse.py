# SPDX-License-Identifier: Apache-2.0
"""A running warehouse by its topics: robots, units, items, people and scenery."""

from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

from nav_msgs.srv import GetMap

from warehouse_client.message_check import fit, subscribe
from warehouse_client.unit_messages import unit_ids, unit_poses
from warehouse_layout.floor import plan_reader
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_msgs.msg import FleetState, People, Scenery, UnitStates, WarehouseObjects


class WarehouseClient:
    """The last messages of a running warehouse; None before the first.

    ros: rospy, or what stands in for it in a test. on_fleet: called with (FleetState before it or
    None, FleetState) for each one, in a thread of rospy. fleet, objects, units, scenery, people:
    the messages.
    """

    def __init__(
        self,
        ros: ModuleType,
        on_fleet: Callable[[FleetState | None, FleetState], object] | None = None,
    ) -> None:
        self._ros, self._call = ros, on_fleet
        # Messages have no types; each is None before the first.
        self.fleet: Any = None
        self.objects: Any = None
        self.units: Any = None
        self.scenery: Any = None
        self.people = People()
        for topic, kind, name in (
            ("objects", WarehouseObjects, "objects"),
            ("unit_states", UnitStates, "units"),
            ("scenery", Scenery, "scenery"),
            ("people", People, "people"),
        ):
            subscribe(ros, f"warehouse/{topic}", kind, self._keep, name, queue_size=1)
        subscribe(ros, "warehouse/fleet", FleetState, self._on_fleet, queue_size=10)

    def _keep(self, message: Any, name: str) -> None:
        setattr(self, name, message)

    def _on_fleet(self, message: Any) -> None:
        before, self.fleet = self.fleet, message
        if self._call:
            self._call(before, message)

    @property
    def is_known(self) -> bool:
        """Whether there is a message of each kind, of fitting revisions."""
        fleet, objects, units = self.fleet, self.objects, self.units
        if fleet is None or objects is None or units is None or self.scenery is None:
            return False
        return fit(objects, units) and fleet.timeline == units.timeline

    def is_known_at(self, now: float) -> bool:
        """Returns whether it is known, by messages not later than `now` [s]: later ones precede a
        jump back in time.
        """
        fleet = self.fleet
        return self.is_known and fleet is not None and fleet.stamp.to_sec() <= now

    @property
    def timeline(self) -> int:
        """The number of the world's timeline, which changes at a jump in time."""
        return _known(self.fleet).timeline

    def plan(self) -> FloorPlan:
        """Reads the FloorPlan by the map service. Raises rospy.ServiceException, FloorError."""
        grid = self._ros.ServiceProxy("warehouse/map", GetMap)().map
        return plan_reader.of_messages(grid, self.scenery)

    def robot_cells(self, plan: FloorPlan) -> dict[int, int]:
        """Returns the cell of each robot, by its id."""
        robots = _known(self.fleet)
        return dict(zip(robots.kiva_id, plan.cell_of(robots.x, robots.y).tolist()))

    def unit_cells(self, plan: FloorPlan) -> dict[int, int]:
        """Returns the cell of each storage unit, by its id; -1 off the floor."""
        return dict(zip(unit_ids(_known(self.objects)), self._cells(plan)))

    def standing_units(self, plan: FloorPlan) -> dict[int, int]:
        """Returns the cells of the units that no robot carries, by id; {} if not known."""
        if not self.is_known:
            return {}
        rows = zip(unit_ids(_known(self.objects)), self._cells(plan), _known(self.units).carrier)
        return {unit: cell for unit, cell, carrier in rows if not carrier and cell >= 0}

    def items(self) -> list[tuple[str, int]]:
        """Returns (item, id of the unit to which it belongs) of all items on units or fallen."""
        ids = unit_ids(_known(self.objects))
        return [(item, ids[unit]) for item, unit in self._homes() if unit >= 0]

    @property
    def fallen_items(self) -> list[str]:
        """The names of the items that lie on the floor."""
        objects = _known(self.objects)
        return [objects.items[item] for item in objects.fallen_item]

    def _cells(self, plan: FloorPlan) -> list[int]:
        x, y, _ = unit_poses(_known(self.units))
        return plan.cell_of(x, y).tolist()

    def _homes(self) -> Iterator[tuple[str, int]]:
        """Yields (item, index of the unit to which it belongs, -1 = none)."""
        objects = _known(self.objects)
        unit_of = list(objects.item_unit)
        for item, unit in zip(objects.fallen_item, objects.fallen_from):
            unit_of[item] = unit
        return zip(objects.items, unit_of)


def _known(message: Any) -> Any:
    if message is None:
        raise ValueError("no message has come yet")
    return message
