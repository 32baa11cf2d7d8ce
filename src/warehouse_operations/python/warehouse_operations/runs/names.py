# SPDX-License-Identifier: Apache-2.0
"""The stations, robots, SKUs and orders of a shift, of which events and settings name some."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from warehouse_operations.runs.event_file import Event
from warehouse_operations.stock.days import check_stock
from warehouse_operations.stock.order_file import DemandError, read_csv

MOST_NAMED = 8  # in a message


@dataclass(frozen=True)
class Names:
    """What there is in a shift. skus, orders (by reference and number): None where they are not
    known. ideal: its robots are. elsewhere: roles of policies that another program has."""

    stations: Sequence[str]
    robots: Collection[int]
    skus: Collection[str] | None
    ideal: bool
    orders: Collection[str] | None = None
    elsewhere: Collection[str] = ()

    def check(self, event: Event) -> None:
        """Raises EventError if an event could not happen."""
        value = event.value
        if event.kind in ("close", "open", "picker"):
            self._check_station(event, value["station"] if event.kind == "picker" else value)
        elif event.kind == "fail" and isinstance(value, int):
            if value not in self.robots:
                raise event.fault(f"is robot {value}; there are 1 to {max(self.robots, default=0)}")
        elif event.kind == "speed" and not self.ideal:
            raise event.fault("holds for ideal robots; simulated ones have that of their model")
        elif event.kind == "sku_out" and self.skus is not None and value not in self.skus:
            raise event.fault(f"is {value}; the stock has no such SKU")
        elif event.kind == "priority" and self.orders is not None:
            if value["order"] not in self.orders:
                raise event.fault(f"is of {value['order']}; no such order is open")
        elif event.kind == "policy" and (roles := value.keys() & set(self.elsewhere)):
            raise event.fault(f"{min(roles)} has no effect: the coordinator decides it by itself")
        elif event.kind == "orders" and self.skus is not None:
            asked = {sku: 0 for order in read_csv(value) for sku, _ in order.lines}
            try:
                check_stock(value, asked, self.skus)
            except DemandError as error:
                raise event.fault(str(error)) from error

    def _check_station(self, event: Event, name: str) -> None:
        if name not in self.stations:
            more = " …" if len(self.stations) > MOST_NAMED else ""
            named = ", ".join(self.stations[:MOST_NAMED])
            raise event.fault(f"is {name}; there are {named}{more}")
