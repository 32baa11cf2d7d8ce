# SPDX-License-Identifier: Apache-2.0
"""Weighs and measures storage units of the running warehouse, with what lies on them."""

from types import ModuleType
from typing import Any

from gazebo_msgs.srv import GetLinkProperties, GetModelProperties
from warehouse_client.unit_messages import unit_ids
from warehouse_client.warehouse import WarehouseClient
from warehouse_msgs.msg import Look
from warehouse_vda5050.master.load_fit import UnitMeasures


class UnitScales:
    """Asks the world for the masses of models, once each. `ros` is rospy."""

    def __init__(self, ros: ModuleType, warehouse: WarehouseClient) -> None:
        self._ros, self._warehouse = ros, warehouse
        self._masses: dict[str, float] = {}  # [kg] by the model's name
        self._model = ros.ServiceProxy("gazebo/get_model_properties", GetModelProperties)
        self._link = ros.ServiceProxy("gazebo/get_link_properties", GetLinkProperties)

    def measure(self, unit: int) -> UnitMeasures:
        """Returns the measures of a unit, as far as the world tells them. Blocks."""
        objects, scenery = self._warehouse.objects, self._warehouse.scenery
        if objects is None or scenery is None:
            return UnitMeasures()
        ids = unit_ids(objects)
        if unit not in ids:
            return UnitMeasures()
        row = ids.index(unit)
        names = [objects.storage_units[row]]
        names += [name for name, on in zip(objects.items, objects.item_unit) if on == row]
        return UnitMeasures(self._mass(names), *_extents(scenery))

    def _mass(self, names: list[str]) -> float | None:
        """Returns the mass of some models [kg]; None where the world does not answer."""
        try:
            return sum(self._mass_of(name) for name in names)
        except (self._ros.ServiceException, OSError, ValueError):
            return None

    def _mass_of(self, name: str) -> float:
        if name not in self._masses:
            model = self._model(name)
            if not model.success:
                raise ValueError(model.status_message)
            links = [self._link(f"{name}::{link}") for link in model.body_names]
            self._masses[name] = sum(link.mass for link in links if link.success)
        return self._masses[name]


def _extents(scenery: Any) -> tuple[float | None, float | None, float | None]:
    """Returns length, width and height of what a storage unit looks like [m]; the shapes of units
    are upright boxes."""
    index = scenery.storage_unit_look
    if index < 0 or not scenery.looks[index].shape_kind:
        return None, None, None
    low, high = [1e9] * 3, [-1e9] * 3
    look: Look = scenery.looks[index]
    for i, link in enumerate(look.shape_link):
        for axis in range(3):
            middle = look.link_pose[7 * link + axis] + look.shape_pose[7 * i + axis]
            half = look.shape_size[3 * i + axis] / 2
            low[axis], high[axis] = min(low[axis], middle - half), max(high[axis], middle + half)
    length, width, height = (round(b - a, 3) for a, b in zip(low, high))
    return length, width, height
