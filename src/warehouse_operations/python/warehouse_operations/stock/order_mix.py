# SPDX-License-Identifier: Apache-2.0
"""Random orders of a wish: with a mean size, or like those of a file.

An order's lines depend on its number and the seed alone. While stock suffices, any fleet gets the
same orders at the same times: shifts of one seed differ by the fleet.
"""

from collections.abc import Callable, Sequence

import numpy as np

from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.order_file import DemandError, OrderDraft, read_csv

DUE_SOON, DUE_SOON_SHARE, DUE_LATER = 30 * 60.0, 0.2, 2 * 3600.0
MOST_PER_HOUR = 1e6
TRIES = 20  # most SKUs drawn for a line before one is in stock
MOST_MEAN = 100.0


class Mixed:
    """Draws orders of 1 + Poisson(lines - 1) lines, each of 1 + Poisson(pieces - 1) pieces.

    1.55 lines have nearly the shares of RAWSim-O's orders.
    """

    def __init__(
        self, assortment: Assortment, rng: np.random.Generator, lines: float, pieces: float
    ) -> None:
        self._skus, self._sums = assortment.skus, np.cumsum(assortment.popularity)
        self._lines, self._pieces = lines, pieces
        self._seed, self._count = int(rng.integers(2**63)), 0

    def draw_anew(self, rng: np.random.Generator) -> None:
        """Draws the orders to come by another generator."""
        self._seed, self._count = int(rng.integers(2**63)), 0

    def order(self, now: float, in_stock: Callable[[str], int]) -> OrderDraft | None:
        """Draws an order of SKUs in stock, by in_stock(sku) [pieces]; None if none of the drawn
        SKUs is."""
        rng = np.random.default_rng((self._seed, self._count))
        self._count += 1
        count = 1 + int(rng.poisson(self._lines - 1))
        due = DUE_SOON if rng.random() < DUE_SOON_SHARE else DUE_LATER
        lines: dict[str, int] = {}
        for _ in range(count * TRIES):
            sku = self._draw(rng)
            pieces = 1 + int(rng.poisson(self._pieces - 1))
            if sku not in lines and in_stock(sku) >= pieces:
                lines[sku] = pieces
                if len(lines) == count:
                    break
        return OrderDraft(tuple(lines.items()), now, now + due) if lines else None

    def _draw(self, rng: np.random.Generator) -> str:
        at = np.searchsorted(self._sums, rng.random() * self._sums[-1], side="right")
        return str(self._skus[min(int(at), len(self._skus) - 1)])


class Alike:
    """Draws orders from those of a file, each with its time until it is due."""

    def __init__(self, orders: Sequence[OrderDraft], rng: np.random.Generator) -> None:
        self._orders = orders
        self._seed, self._count = int(rng.integers(2**63)), 0

    def draw_anew(self, rng: np.random.Generator) -> None:
        """Draws the orders to come by another generator."""
        self._seed, self._count = int(rng.integers(2**63)), 0

    def order(self, now: float, in_stock: Callable[[str], int]) -> OrderDraft | None:
        """Draws an order, with its SKUs in stock or not."""
        rng = np.random.default_rng((self._seed, self._count))
        self._count += 1
        draft = self._orders[int(rng.integers(len(self._orders)))]
        due = now + draft.due - draft.at if draft.due else 0.0
        return OrderDraft(draft.lines, now, due, draft.priority)


def text_of(per_hour: float, lines: float, pieces: float, file: str = "") -> str:
    """Returns the orders text that make() reads: `mix:…`."""
    return f"mix:{per_hour!r}:" + (file or f"{lines!r}x{pieces!r}")


def make(
    text: str, assortment: Assortment, rng: np.random.Generator, capacity: float = float("inf")
) -> tuple[float, Mixed | Alike]:
    """Returns the rate [1/h] and the source of orders of `mix:PER_HOUR:LINESxPIECES|FILE.csv`.

    Raises DemandError.
    """
    rate, _, mix = text.removeprefix("mix:").partition(":")
    per_hour = _number(text, rate, 0, MOST_PER_HOUR)
    if mix.endswith(".csv"):
        orders = read_csv(mix, set(assortment.skus), capacity)
        if not orders:
            raise DemandError(f"{mix}: there is no order in it")
        return per_hour, Alike(orders, rng)
    lines, _, pieces = mix.partition("x")
    means = (_number(text, part, 1, MOST_MEAN) for part in (lines, pieces))
    return per_hour, Mixed(assortment, rng, *means)


def _number(text: str, value: str, least: float, most: float) -> float:
    try:
        number = float(value)
    except ValueError:
        number = -1.0
    if not (least <= number <= most and number > 0):
        raise DemandError(
            f"orders are '{text}'; mix:PER_HOUR:LINESxPIECES or mix:PER_HOUR:FILE.csv was expected,"
            f" with up to {MOST_PER_HOUR:g} orders an hour of 1 to {MOST_MEAN:g} lines and pieces"
        )
    return number
