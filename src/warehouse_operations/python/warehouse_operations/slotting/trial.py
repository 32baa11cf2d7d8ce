# SPDX-License-Identifier: Apache-2.0
"""Shifts with the proposed and with a random stock: of the same bins, SKUs, pieces and orders.

SKUs are placed by the even orders of a file alone; the shifts draw their orders from the odd ones.
"""

import csv
import hashlib
import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_layout.file.layout_file import LayoutFile, text_of
from warehouse_layout.file.sku_master import Sku
from warehouse_layout.place import placement
from warehouse_operations.fleets.ideal_floor import IdealFloor
from warehouse_operations.runs import layout_site
from warehouse_operations.runs.operations import Operations
from warehouse_operations.slotting.proposal import Lot, Pairs, Slot, propose
from warehouse_operations.stock.assortment import Assortment, stocked
from warehouse_operations.stock.demand import DemandError
from warehouse_operations.stock.order_file import OrderDraft
from warehouse_operations.stock.site import Site, Stock
from warehouse_operations.stock.travel import Travel

WARM_UP = 0.5  # left out at the begin of a shift [h]
FIGURES = ("pieces_per_hour", "pieces_a_unit", "units_an_order", "metres_a_piece", "late")


@dataclass(frozen=True)
class Catalogue:
    """A layout with its orders and SKUs."""

    file: LayoutFile
    orders: Sequence[OrderDraft]
    skus: Mapping[str, Sku]

    def site(self) -> Site:
        """Returns the warehouse without stock."""
        laid = placement.place(self.file, 1)
        return replace(layout_site.of_file(Site.of_layout(laid, self.file.title), self.file))

    def lots(self, site: Site) -> list[Lot]:
        """Returns the content of the bins: the layout's own stock, or a random one of the orders'
        SKUs, by their popularity. Raises DemandError for too few bins."""
        if site.stock:
            lots = [Lot(row.sku, row.pieces) for row in site.stock]
        else:
            asked = Counter(sku for order in self.orders for sku, _ in order.lines)
            if len(asked) > len(site.items):
                raise DemandError(
                    f"{len(asked)} SKUs are asked for; there are {len(site.items)} bins (items),"
                    " one of each SKU at least was expected"
                )
            own = Assortment.of_lines(asked)
            drawn = stocked(site.items, np.random.default_rng(1), own=own)[1]
            lots = [Lot(bin_.sku, pieces) for bin_, pieces in drawn]
        return [Lot(lot.sku, self._fitting(lot)) for lot in lots]

    def _fitting(self, lot: Lot) -> int:
        most = self.skus[lot.sku].pieces_a_bin if lot.sku in self.skus else 0
        return min(lot.pieces, most) if most else lot.pieces

    def slots(self, orders: Sequence[OrderDraft]) -> list[Slot]:
        """Returns the proposal by some of the orders."""
        site = self.site()
        room = Counter(unit for _, unit in site.items)
        return propose(self.lots(site), room, nearest(site), Pairs.of(orders), self.skus)


def nearest(site: Site) -> list[int]:
    """Returns the units by their way to the next picking station, the nearest first."""
    travel = Travel(site.plan, site.kinematics)
    floor = IdealFloor(site.plan, site.units, travel)
    units = np.array(list(floor.units))
    cells = np.array(list(floor.units.values()))
    seconds = [
        travel.loaded_to(station.service_cell).seconds[cells]
        for station in site.plan.stations
        if station.kind == "PICK"
    ]
    return [int(unit) for unit in units[np.argsort(np.min(seconds, axis=0), kind="stable")]]


class Trial:
    """Pairs of shifts, one a seed; each is kept in a folder and simulated once."""

    def __init__(
        self, catalogue: Catalogue, folder: Path, *, per_hour: float, hours: float, robots: int
    ) -> None:
        self._catalogue, self._per_hour, self._hours = catalogue, per_hour, hours
        self._robots, self._kept = robots, folder / "trials.jsonl"
        folder.mkdir(parents=True, exist_ok=True)
        self._odd = folder / "judged.csv"
        _write_orders(self._odd, catalogue.orders[1::2])
        self._slots = catalogue.slots(catalogue.orders[::2])

    def pair(self, seed: int) -> dict[str, dict[str, float]]:
        """Returns the FIGURES of a seed, `proposed` and by `chance`."""
        key = self._key(seed)
        for line in self._kept.read_text("utf-8").splitlines() if self._kept.exists() else ():
            row = json.loads(line)
            if row["key"] == key:
                return dict(row["figures"])
        chance = np.random.default_rng((seed, 2))
        order = chance.permutation(len(self._slots))
        shuffled = [
            Slot(self._slots[i].sku, self._slots[i].pieces, slot.unit)
            for i, slot in zip(order, self._slots)
        ]
        figures = {
            "proposed": self._run(self._slots, seed),
            "chance": self._run(shuffled, seed),
        }
        with self._kept.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"key": key, "figures": figures}) + "\n")
        return figures

    def _key(self, seed: int) -> str:
        text = repr(
            (
                text_of(self._catalogue.file),
                self._slots,
                self._odd.read_text("utf-8"),
                (seed, self._per_hour, self._hours, self._robots),
            )
        )
        return hashlib.blake2b(text.encode(), digest_size=8).hexdigest()

    def _run(self, slots: Sequence[Slot], seed: int) -> dict[str, float]:
        site = _stocked(self._catalogue.site(), slots)
        if self._robots:
            laid = placement.place(self._catalogue.file, 1, self._robots)
            site = replace(site, robots=Site.of_layout(laid).robots)
        orders = f"mix:{self._per_hour:g}:{self._odd}"
        policies = self._catalogue.file.policies
        with Operations(site=site, orders=orders, seed=seed, policies=policies) as ops:
            ops.run(hours=WARM_UP)
            before = _totals(ops)
            ops.run(hours=self._hours)
            after = _totals(ops)
        return _figures({name: after[name] - before[name] for name in after}, self._hours)


def _stocked(site: Site, slots: Sequence[Slot]) -> Site:
    """Returns a site whose bins hold the slots' pieces, unit by unit."""
    items: dict[int, list[str]] = {}
    for item, unit in site.items:
        items.setdefault(unit, []).append(item)
    stock = [Stock(items[slot.unit].pop(), slot.sku, slot.pieces) for slot in slots]
    return replace(site, stock=stock)


def _totals(ops: Operations) -> dict[str, float]:
    tally = ops.context.tally
    return {
        "pieces": tally.items_picked,
        "orders": tally.orders_completed,
        "late": tally.late_orders,
        "units": tally.pick_visits,
        "metres": ops.fleet.distance_m,
    }


def _figures(change: Mapping[str, float], hours: float) -> dict[str, float]:
    pieces, orders = max(change["pieces"], 1), max(change["orders"], 1)
    return {
        "pieces_per_hour": change["pieces"] / hours,
        "pieces_a_unit": change["pieces"] / max(change["units"], 1),
        "units_an_order": change["units"] / orders,
        "metres_a_piece": change["metres"] / pieces,
        "late": change["late"] / orders,
    }


def _write_orders(path: Path, orders: Sequence[OrderDraft]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(("reference", "sku", "quantity", "at", "due"))
        for i, order in enumerate(orders, start=1):
            due = f"{order.due:g}" if order.due else ""
            for sku, pieces in order.lines:
                table.writerow((order.reference or f"order{i}", sku, pieces, f"{order.at:g}", due))


def compared(
    pairs: Sequence[Mapping[str, Mapping[str, float]]],
    interval: Callable[[Sequence[float]], tuple[float, float | None]],
) -> dict[str, Any]:
    """Returns {figure: {proposed, chance, difference, half}}, the means of pairs."""
    out: dict[str, Any] = {}
    for name in FIGURES:
        mean, half = interval([pair["proposed"][name] - pair["chance"][name] for pair in pairs])
        sides = {
            side: sum(pair[side][name] for pair in pairs) / len(pairs)
            for side in ("proposed", "chance")
        }
        out[name] = sides | {"difference": mean, "half": half}
    return out
