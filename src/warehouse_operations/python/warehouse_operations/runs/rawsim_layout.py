# SPDX-License-Identifier: Apache-2.0
"""Reads layout configurations (.xlayo) of RAWSim-O as a Site whose pods are full by weight."""

from pathlib import Path

from warehouse_layout.convert.common import PathName
from warehouse_layout.convert.rawsim import xlayo
from warehouse_layout.convert.rawsim.xml_fields import read_root, text_of
from warehouse_layout.place import placement
from warehouse_operations.goods.kinds import Goods, Kinds
from warehouse_operations.runs import layout_site
from warehouse_operations.runs.rawsim_bots import USUAL, kinematics
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.site import Site

SUFFIX = ".xlayo"
BUNDLE = 10.0  # seconds for a bundle, unless the file says another number
CAPACITY = 500.0  # weight that a pod holds, unless the file says another
CHANCE = 1  # the seed by which pods and robots stand where they do: the same in every shift


def is_configuration(path: PathName) -> bool:
    """Returns whether a file's name is that of a layout configuration."""
    return str(path).lower().endswith(SUFFIX)


def read(path: PathName) -> Site:
    """Returns the Site of an .xlayo file. Raises InstanceError."""
    file, _ = xlayo.read(path)
    root = read_root(path, "LayoutConfiguration")
    site = Site.of_layout(placement.place(file, CHANCE), file.name or Path(path).stem)
    capacity = text_of(path, root, "PodCapacity", CAPACITY)
    goods = Goods(Kinds.drawn(), dict.fromkeys(site.units, capacity))
    by_station = dict(layout_site.settings_of(file).by_station)
    bundle = text_of(path, root, "ItemBundleTransferTime", BUNDLE)
    for station in site.plan.stations:
        if station.kind == "REPLENISH":
            by_station[station.name] = {**by_station.get(station.name, {}), "bundle_s": bundle}
    return Site(
        site.plan,
        site.robots,
        site.units,
        goods.items(),
        site.name,
        kinematics(path, *(text_of(path, root, *usual) for usual in USUAL.items())),
        Settings(by_station=by_station),
        goods=goods,
    )
