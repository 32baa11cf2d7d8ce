# SPDX-License-Identifier: Apache-2.0
"""Reads instances (.xinst) and layout configurations (.xlayo) of RAWSim-O as a Site."""

from collections.abc import Sequence
from typing import Any
from xml.etree.ElementTree import Element

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_layout.convert.common import PathName
from warehouse_layout.convert.rawsim.instance import read_floor
from warehouse_layout.convert.rawsim.xml_fields import InstanceError, number_of
from warehouse_operations.goods.kinds import Goods, Kinds
from warehouse_operations.runs import rawsim_layout
from warehouse_operations.runs.rawsim_bots import USUAL, kinematics
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.site import Site

__all__ = ["InstanceError", "read_instance"]

CAPACITY = 500.0  # weight that a pod holds, unless its element says another


def read_instance(path: PathName) -> Site:
    """Returns the Site of an .xinst or .xlayo file. Raises InstanceError."""
    if rawsim_layout.is_configuration(path):
        return rawsim_layout.read(path)
    instance = read_floor(path)
    goods = Goods(
        Kinds.drawn(),
        {
            unit: number_of(path, pod, "Capacity", CAPACITY)
            for unit, pod in zip(instance.units, instance.pods)
        },
    )
    overrides = {name: _times(path, seconds) for name, seconds in instance.elements.items()}
    return Site(
        instance.plan,
        instance.robots,
        instance.units,
        goods.items(),
        instance.name,
        _kinematics(path, instance.bots),
        Settings(by_station=overrides),
        goods=goods,
    )


def _times(path: PathName, element: Element) -> dict[str, Any]:
    if element.tag == "InputStation":
        return {"bundle_s": number_of(path, element, "ItemBundleTransferTime", 10.0)}
    piece = number_of(path, element, "ItemTransferTime", 10.0)
    return {
        "piece_s": piece,
        "pick_s": min(number_of(path, element, "ItemPickTime", Settings.pick_s), piece),
        "slots": int(number_of(path, element, "Capacity", Settings.slots)),
    }


def _kinematics(path: PathName, bots: Sequence[Element]) -> Kinematics:
    if not bots:
        raise InstanceError(f"{path}: there is no Bot")
    kinds = {tuple(number_of(path, bot, *usual) for usual in USUAL.items()) for bot in bots}
    if len(kinds) > 1:
        raise InstanceError(f"{path}: bots of {len(kinds)} kinds; all alike was expected")
    return kinematics(path, *kinds.pop())
