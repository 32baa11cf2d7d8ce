# SPDX-License-Identifier: Apache-2.0
"""Sources of orders and bundles: `fill`, `fill:N`, `poisson:PER_HOUR`, a CSV file (see
order_file), `day:…`, `demand:…` or `mix:…` (see orders_text), or `none`."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Protocol

import numpy as np

from warehouse_operations.goods.order_sizes import OrderSizes
from warehouse_operations.stock import days, order_mix, orders_text
from warehouse_operations.stock.acceptance import MOST_WAITING
from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.inventory import ROOMY
from warehouse_operations.stock.order_file import DemandError, OrderDraft, read_csv
from warehouse_operations.stock.order_mix import DUE_LATER, DUE_SOON, DUE_SOON_SHARE, MOST_PER_HOUR
from warehouse_operations.stock.orders import Backlog
from warehouse_operations.stock.orders_text import DAY

FILL, FILL_A_STATION = 200, 5  # orders that always wait: the fewest, and those per station
POISSON = 160.0  # orders a picking station and hour
BUNDLES = 45.0  # bundles a replenishing station and hour, with poisson
LINES, LINE_SHARES = (1, 2, 3, 4), np.array([0.554, 0.350, 0.088, 0.009])
LINE_SUMS = np.cumsum(LINE_SHARES / LINE_SHARES.sum())
LINE_SUMS /= LINE_SUMS[-1]
PIECES_MEAN, PIECES_DEVIATION, PIECES_LEAST, PIECES_MOST = 1.0, 0.3, 1, 3
BUNDLE_LEAST, BUNDLE_MOST = 4, ROOMY
MOST_FILL = 10_000
PAST = 300.0  # least time of a rate of recent orders [s]
AT_ONCE, PAUSE = 1_000, 1.0  # most orders of a file that come together; time until the next [s]


class DrawsOrders(Protocol):
    """Draws orders one by one."""

    def order(self, now: float, in_stock: Callable[[str], int]) -> OrderDraft | None:
        """Returns the order that comes now, or None."""

    def draw_anew(self, rng: np.random.Generator) -> None:
        """Draws the orders to come by another generator."""


class Customers:
    """Draws orders from an assortment; the same generator state gives the same orders."""

    def __init__(
        self, assortment: Assortment, rng: np.random.Generator, sizes: OrderSizes | None = None
    ) -> None:
        self.assortment, self._rng, self._sizes = assortment, rng, sizes

    def order(self, now: float, in_stock: Callable[[str], int]) -> OrderDraft | None:
        """Draws an order of SKUs in stock, by in_stock(sku) [pieces]; None if none of the drawn
        SKUs is."""
        rng = self._rng
        count = self._lines()
        lines = {}
        for _ in range(count * 20):
            sku = self.assortment.skus[self._draw()]
            pieces = self._pieces()
            if sku not in lines and in_stock(sku) >= pieces:
                lines[sku] = pieces
                if len(lines) == count:
                    break
        if not lines:
            return None
        soon, share, later = (
            (self._sizes.due_soon, self._sizes.share_soon, self._sizes.due_later)
            if self._sizes
            else (DUE_SOON, DUE_SOON_SHARE, DUE_LATER)
        )
        due = soon if rng.random() < share else later
        return OrderDraft(tuple(lines.items()), now, now + due)

    def _lines(self) -> int:
        if self._sizes:
            return self._sizes.lines.draw(self._rng)
        return LINES[int(np.searchsorted(LINE_SUMS, self._rng.random(), side="right"))]

    def _pieces(self) -> int:
        if self._sizes:
            return self._sizes.pieces.draw(self._rng)
        pieces = round(self._rng.normal(PIECES_MEAN, PIECES_DEVIATION))
        return min(max(pieces, PIECES_LEAST), PIECES_MOST)

    def draw_anew(self, rng: np.random.Generator) -> None:
        """Draws the orders to come by another generator."""
        self._rng = rng

    def _draw(self) -> int:
        if not hasattr(self, "_sums"):
            self._sums = np.cumsum(self.assortment.popularity)
        at = np.searchsorted(self._sums, self._rng.random() * self._sums[-1], side="right")
        return int(min(at, len(self._sums) - 1))


class Fill:
    """Keeps a constant number of orders waiting."""

    def __init__(self, customers: Customers, waiting: int = FILL) -> None:
        self.customers, self.waiting = customers, waiting
        self.bundles_per_hour = 0.0

    def draw_anew(self, rng: np.random.Generator, _now: float) -> None:
        """Draws the orders to come by another generator."""
        self.customers.draw_anew(rng)

    def next_time(self) -> float:
        """Returns inf: new orders replace those that leave the backlog."""
        return float("inf")

    def due(
        self, now: float, backlog: Backlog, in_stock: Callable[[str], int]
    ) -> Iterator[OrderDraft]:
        """Yields the orders that come now."""
        for _ in range(self.waiting - len(backlog)):
            draft = self.customers.order(now, in_stock)
            if draft is None:
                return
            yield draft


class Poisson:
    """Orders and bundles of Poisson processes with mean rates [1/h]."""

    def __init__(
        self,
        customers: DrawsOrders,
        per_hour: float,
        bundles_per_hour: float,
        rng: np.random.Generator,
        now: float = 0.0,
    ) -> None:
        self.customers, self.per_hour, self._rng = customers, per_hour, rng
        self.bundles_per_hour = bundles_per_hour
        self._next = now
        self._wait()

    def draw_anew(self, rng: np.random.Generator, now: float) -> None:
        """Draws what comes after a time [s] by another generator."""
        self._rng, self._next = rng, now
        self.customers.draw_anew(rng)
        self._wait()

    def next_time(self) -> float:
        """Returns when the next order comes [s]."""
        return self._next

    def due(
        self, now: float, backlog: Backlog, in_stock: Callable[[str], int]
    ) -> Iterator[OrderDraft]:
        """Yields the orders that come now."""
        while self._next <= now:
            draft = self.customers.order(self._next, in_stock)
            self._wait()
            if draft:
                yield draft

    def _wait(self) -> None:
        self._next += self._rng.exponential(3600.0 / self.per_hour)


def alike(
    recent: Sequence[OrderDraft], began: float, now: float, rng: np.random.Generator
) -> Poisson | None:
    """Returns orders like recent ones of a shift that began at a time [s], at their rate; None
    without any. now: when the first may come."""
    if not recent:
        return None
    since = max(began, recent[0].at)
    per_hour = 3600 * len(recent) / max(now - since, PAST)
    return Poisson(order_mix.Alike(recent, rng), per_hour, 0.0, rng, now)


class FromFile:
    """The orders of a CSV file: each at its time, or a little later while many others come or
    wait."""

    bundles_per_hour = 0.0

    def __init__(self, drafts: Iterable[OrderDraft]) -> None:
        self._drafts = sorted(drafts, key=lambda draft: draft.at)[::-1]
        self._more_at = 0.0

    def draw_anew(self, _rng: np.random.Generator, _now: float) -> None:
        """Does nothing: what comes is known."""

    def skip_to(self, now: float) -> None:
        """Drops the orders up to a time [s]."""
        while self._drafts and self._drafts[-1].at <= now:
            self._drafts.pop()

    def next_time(self) -> float:
        """Returns when the next order comes [s]; inf after the last."""
        return max(self._drafts[-1].at, self._more_at) if self._drafts else float("inf")

    def due(
        self, now: float, backlog: Backlog, in_stock: Callable[[str], int]
    ) -> Iterator[OrderDraft]:
        """Yields the orders that come now."""
        for _ in range(AT_ONCE):
            if self.next_time() > now:
                return
            if backlog.lines + len(self._drafts[-1].lines) > MOST_WAITING:
                break
            yield self._drafts.pop()
        self._more_at = now + PAUSE


def make_demand(
    text: str,
    assortment: Any,
    stations: tuple[int, int],
    rng: np.random.Generator,
    now: float = 0.0,
    capacity: float = float("inf"),
    sizes: OrderSizes | None = None,
) -> Any:
    """Returns the demand that an orders text of operations.launch or simulate means; raises
    DemandError.

    assortment: None: any SKU may be ordered. stations: numbers of (picking, replenishing) ones.
    now: begin of the demand [s]. capacity: pieces that all bins can hold. sizes: of orders that are
    drawn by `fill` or `poisson`.
    """
    customers = Customers(assortment, rng, sizes)
    name, _, value = str(text).partition(":")
    if text == "none":
        return FromFile([])
    if name == "fill":
        waiting = max(FILL, FILL_A_STATION * stations[0])
        return Fill(customers, int(_number(text, value, waiting, MOST_FILL, whole=True)))
    if name == "poisson":
        per_hour = _number(text, value, POISSON * stations[0], MOST_PER_HOUR)
        return Poisson(customers, per_hour, BUNDLES * stations[1], rng, now)
    if name == "mix":
        per_hour, mixed = order_mix.make(str(text), assortment, rng, capacity)
        return Poisson(mixed, per_hour, BUNDLES * stations[1], rng, now)
    if day := orders_text.day_of(str(text)):
        skus = assortment.skus if assortment else None
        if day.kind == DAY:
            return FromFile(days.orders_of(day, skus, rng, capacity))
        return days.drawn(day, skus, rng, now)
    if str(text).endswith(".csv"):
        return FromFile(read_csv(text, set(assortment.skus) if assortment else None, capacity))
    raise DemandError(f"orders are '{text}'; {orders_text.EXPECTED} was expected")


def _number(text: str, value: str, default: float, most: float, whole: bool = False) -> float:
    if not value:
        return default
    try:
        number = int(value) if whole else float(value)
    except ValueError:
        number = 0
    if not 0 < number <= most:
        raise DemandError(
            f"orders are '{text}'; a number above 0, up to {most:g}, was expected after the colon"
        )
    return number
