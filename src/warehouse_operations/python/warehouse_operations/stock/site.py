# SPDX-License-Identifier: Apache-2.0
"""A warehouse before a shift: its floor, robots, units and stock."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_layout.file.item_weights import ItemWeights
from warehouse_layout.floor import plan_reader
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.place.layout import Layout
from warehouse_operations.goods.kinds import Goods
from warehouse_operations.goods.order_sizes import OrderSizes
from warehouse_operations.stock.assortment import INITIAL_LEVEL
from warehouse_operations.stock.settings import Settings

if TYPE_CHECKING:
    from kiva_plugin_cpp import World


class Stock(NamedTuple):
    """Pieces of a SKU in the bin of that item."""

    item: str
    sku: str
    pieces: int


@dataclass(frozen=True)
class Site:
    """A floor with its robots and storage units, cells by id, and its bins, (name, unit)."""

    plan: FloorPlan
    robots: Mapping[int, int]
    units: Mapping[int, int]
    items: list[tuple[str, int]]
    name: str = ""
    kinematics: Kinematics = field(default_factory=Kinematics)
    settings: Settings = field(default_factory=Settings)
    skus: int | None = None  # number of SKUs; None: by the number of bins
    level: float = INITIAL_LEVEL  # of the stock at first, over its room
    stock: Sequence[Stock] = ()  # at first, bin by bin; (): drawn by chance
    goods: Goods | None = None  # SKUs and units that are full by weight; None: by their bins
    sizes: OrderSizes | None = None  # of drawn orders; None: RAWSim-O's usual ones
    weights: ItemWeights | None = None  # of the items by their SKUs; None: as their model

    @classmethod
    def of_layout(cls, laid: Layout, name: str = "") -> "Site":
        """Returns the site of a Layout with a plan, as its world would stand."""
        plan = laid.plan
        assert plan is not None

        def cells(points: np.ndarray) -> dict[int, int]:
            return _cells(plan, range(1, len(points) + 1), points[:, 0], points[:, 1])

        items = [(f"item{n}", int(unit) + 1) for n, unit in enumerate(laid.item_unit, start=1)]
        return cls(plan, cells(laid.robots), cells(laid.units), items, name)

    @classmethod
    def of_world(cls, world: "World", name: str = "") -> "Site":
        """Returns the site of an in-process kiva_plugin_cpp.World."""
        plan = plan_reader.of_world(world)
        fleet, units, fallen = world.fleet, world.storage_units, world.fallen_items
        unit_of = {int(i["item_id"]): int(i["shelf_id"]) for i in world.items}
        unit_of |= {int(i["item_id"]): int(i["shelf_id"]) for i in fallen}
        return cls(
            plan,
            _cells(plan, fleet.kiva_id.tolist(), fleet.x, fleet.y),
            _cells(plan, units["shelf_id"].tolist(), units["x"], units["y"]),
            [(f"item{item}", unit) for item, unit in unit_of.items() if unit],
            name,
        )


def _cells(plan: FloorPlan, ids: Iterable[int], x: np.ndarray, y: np.ndarray) -> dict[int, int]:
    """Returns {id: cell} of points [m]."""
    return dict(zip(ids, plan.cell_of(x, y).tolist()))
