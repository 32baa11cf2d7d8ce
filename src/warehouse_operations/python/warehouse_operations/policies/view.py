# SPDX-License-Identifier: Apache-2.0
"""The state of a shift as its policies see it."""

from collections import defaultdict
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from warehouse_operations.stock.assortment import CAPACITY, Assortment
from warehouse_operations.stock.event_queue import Clock
from warehouse_operations.stock.goods_in import GoodsIn
from warehouse_operations.stock.inventory import Inventory
from warehouse_operations.stock.orders import Backlog, Bundle, Order
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.stations import WorkStation
from warehouse_operations.stock.units_by_id import UnitSet
from warehouse_operations.stock.whereabouts import Whereabouts

RANKS_KEPT = 300.0  # lifetime of the units' ranking by turnover [s]


@dataclass(eq=False)
class View:
    """The `view` of a policy on its shift, read only.

    clock: simulated times [s]. backlog: the orders that no station has. orders: all that are not
    over, by id. goods_in: the bundles that have no bin yet. free_units: the ids of units that stand
    in storage and may be asked for. settings: those of the shift. rng: for policies that draw lots.
    """

    clock: Clock
    inventory: Inventory
    backlog: Backlog
    floor: Whereabouts
    stations: Collection[WorkStation]
    orders: Mapping[int, Order]
    goods_in: GoodsIn
    free_units: UnitSet
    assortment: Assortment
    settings: Settings
    rng: np.random.Generator

    def __post_init__(self) -> None:
        self._stations = {station.name: station for station in self.stations}
        self._turnover_rank: dict[int, float] = {}
        self._ranked_at = -np.inf
        self._popularity_rank = _ranks_of(self.assortment)
        self._sku_index = {sku: i for i, sku in enumerate(self.assortment.skus)}
        self._demand_sums = np.cumsum(self.assortment.popularity)
        self._refill_weights = np.zeros(len(self._sku_index))

    @property
    def now(self) -> float:
        """The simulated time [s]."""
        return self.clock.now

    def station(self, name: str) -> WorkStation:
        """Returns the WorkStation of that name. Raises KeyError."""
        return self._stations[name]

    # Stock.

    @property
    def bundles(self) -> Mapping[int, Bundle]:
        """The Bundles that wait for a place, by id."""
        return self.goods_in.bundles

    @property
    def pieces_ordered(self) -> int:
        """The number of ordered pieces that have no bin yet."""
        return self.goods_in.pieces + self.inventory.expected

    def pieces_at_door(self, sku: str) -> int:
        """Returns how many pieces of a SKU were ordered and have no bin yet."""
        return self.goods_in.pieces_of.get(sku, 0)

    def in_stock(self, order: Order) -> bool:
        """Returns whether every missing piece of an order lies in a bin and is promised to no
        order.

        A line larger than a bin's capacity is begun with a bin's content: this makes room for more.
        """
        available = self.inventory.available
        return all(available(ln.sku) >= min(ln.missing, CAPACITY) for ln in order.lines)

    def stock_of(self, sku: str) -> int:
        """Returns how many pieces of a SKU are expected, or in bins and promised to no order."""
        return self.inventory.available(sku) + self.inventory.incoming(sku)

    def work(self, unit: int) -> int:
        """Returns how many free pieces on a unit the orders of the backlog ask for."""
        demand, pieces = self.backlog.demand, 0
        for bin_ in self.inventory.of_unit[unit]:
            asked = demand.get(bin_.sku)
            if asked:
                pieces += min(bin_.quantity - bin_.reserved, asked)
        return pieces

    def room(self, unit: int) -> float:
        """Returns how many pieces can be put into a unit's bins; or the weight, where units have
        limits."""
        return self.inventory.room_on(unit)

    def sku_to_refill(self) -> str | None:
        """Draws a SKU, weighted by its number of bins with room for a bundle; None without such a
        bin. Where units have limits, it is drawn by its share of the demand."""
        if self.inventory.goods:
            return self._sku_by_demand()
        changed = self.inventory.room_changed | self.goods_in.changed
        self.inventory.room_changed.clear()
        self.goods_in.changed.clear()
        for sku in changed & self._sku_index.keys():
            room = self.inventory.roomy[sku] - self.pieces_at_door(sku) / 8
            self._refill_weights[self._sku_index[sku]] = max(room, 0)
        sums = np.cumsum(self._refill_weights)
        if not sums[-1] > 0:
            return None
        at = np.searchsorted(sums, self.rng.random() * sums[-1], side="right")
        return self.assortment.skus[min(int(at), len(sums) - 1)]

    def _sku_by_demand(self) -> str:
        sums = self._demand_sums
        at = np.searchsorted(sums, self.rng.random() * sums[-1], side="right")
        return self.assortment.skus[min(int(at), len(sums) - 1)]

    def usual_bundle(self, sku: str) -> int:
        """Returns the pieces of each bundle of a SKU; 0: they differ."""
        return self.inventory.goods.bundle(sku) if self.inventory.goods else 0

    def shortages(self) -> dict[str, int]:
        """Returns the pieces that orders need above stock and ordered pieces, by SKU."""
        lacking = {s: n - self.pieces_at_door(s) for s, n in self.lacking().items()}
        return {sku: pieces for sku, pieces in lacking.items() if pieces > 0}

    def lacking(self) -> dict[str, int]:
        """Returns the pieces that orders need above stock, by SKU."""
        demand: dict[str, int] = defaultdict(int, self.backlog.demand)
        for station in self.stations:
            for line in station.missing.values():
                demand[line.sku] += line.missing
        lacking = {sku: pieces - self.stock_of(sku) for sku, pieces in demand.items()}
        return {sku: pieces for sku, pieces in lacking.items() if pieces > 0}

    # Places.

    def seconds_to(self, station: str, unit: int) -> float:
        """Returns how long a unit takes to a station without traffic [s]; inf if it is carried."""
        return self.floor.seconds_to(station, unit)

    def seconds_to_all(self, station: str, units: np.ndarray) -> np.ndarray:
        """Returns seconds_to() of units, (n,) [s]."""
        return self.floor.seconds_to_all(station, units)

    def cell(self, unit: int) -> int | None:
        """Returns the cell where a unit stands; None while it is carried."""
        return self.floor.cells.get(unit)

    def first_cell(self, unit: int) -> int:
        """Returns the cell where a unit stood as the shift began."""
        return self.floor.units[unit]

    def first_cell_of_robot(self, kiva_id: int) -> int | None:
        """Returns the cell where a robot stood as the shift began; None for an unknown robot."""
        return self.floor.robots.get(kiva_id)

    def cells_apart(self, cell: int, cells: np.ndarray) -> np.ndarray:
        """Returns the metres along the axes between a cell and others, (n,)."""
        return self.floor.apart(cell, cells)

    def place_rank(self, cells: np.ndarray) -> np.ndarray:
        """Returns the ranks of storage places, (n,): 0 nearest to picking stations, 1 farthest."""
        return self.floor.place_rank(cells)

    def stored_units_near(self, cell: int, count: int) -> list[int]:
        """Returns the units nearest to a cell that stand in storage and may be asked for."""
        units = sorted(self.free_units & self.floor.cells.keys())
        apart = self.floor.apart(cell, self.floor.cells.of(np.array(units, int)))
        return [units[i] for i in np.argsort(apart, kind="stable")[:count]]

    # Ranks.

    def popularity_rank(self, sku: str) -> float:
        """Returns the rank of a SKU by demand, from 0 for the most to nearly 1 for the least."""
        return self._popularity_rank[sku]

    def turnover_rank(self, unit: int) -> float:
        """Returns the rank of a unit by the demand for its pieces, from 0 for the most to nearly
        1."""
        if self.now - self._ranked_at >= RANKS_KEPT:
            self._turnover_rank = self._rank_units()
            self._ranked_at = self.now
        return self._turnover_rank.get(unit, 1.0)

    def _rank_units(self) -> dict[int, float]:
        share = dict(zip(self.assortment.skus, self.assortment.popularity))
        units = self.inventory.of_unit
        turnover = {u: sum(share.get(b.sku, 0) for b in units[u] if b.quantity) for u in units}
        order = sorted(turnover, key=lambda unit: (-turnover[unit], unit))
        return {unit: i / len(order) for i, unit in enumerate(order)}


def _ranks_of(assortment: Assortment) -> dict[str, float]:
    order = np.argsort(-assortment.popularity, kind="stable")
    return {assortment.skus[i]: rank / len(order) for rank, i in enumerate(order)}
