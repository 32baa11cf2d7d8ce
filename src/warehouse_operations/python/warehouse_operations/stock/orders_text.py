# SPDX-License-Identifier: Apache-2.0
"""The orders text of a shift, where it names a file.

    FILE.csv                      the orders of a file
    mix:PER_HOUR:FILE.csv         random orders at that rate, like those of a file
    day:FILE.csv                  the day as it was: each order at its time
    demand:FILE.demand.yaml       days drawn from a description (demand_file)
    day:FILE.csv*1.3              either, with 1.3 times the orders

`run-in:MINUTES:` before a day repeats the orders of its first hour before it, so that the warehouse
is at work when the day begins.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

from warehouse_operations.stock.order_file import DemandError

DAY, DEMAND, MIX, RUN_IN = "day", "demand", "mix", "run-in"
MOST_FACTOR = 1000.0
MOST_RUN_IN = 24 * 60.0  # [min]
EXPECTED = (
    "fill, fill:N, poisson:PER_HOUR, FILE.csv, day:FILE.csv, demand:FILE.yaml, either of these with"
    " *1.3 for 1.3 times the orders, or none"
)


@dataclass(frozen=True)
class DayText:
    """A day: of a file of orders (DAY) or of a description of demand (DEMAND).

    factor: of the number of orders. run_in: minutes before the day.
    """

    kind: str
    file: str
    factor: float = 1.0
    run_in: float = 0.0

    def __str__(self) -> str:
        before = f"{RUN_IN}:{self.run_in:g}:" if self.run_in else ""
        return f"{before}{self.kind}:{self.file}" + (
            f"*{self.factor:g}" if self.factor != 1 else ""
        )


def day_of(text: str) -> DayText | None:
    """Returns the day that an orders text asks for, or None. Raises DemandError."""
    minutes, rest = 0.0, text
    if text.startswith(f"{RUN_IN}:"):
        number, _, rest = text.removeprefix(f"{RUN_IN}:").partition(":")
        minutes = _number(text, number, MOST_RUN_IN)
    kind, colon, file = rest.partition(":")
    if kind not in (DAY, DEMAND) or not colon:
        return None
    factor = 1.0
    if "*" in file:
        file, _, number = file.rpartition("*")
        factor = _number(text, number, MOST_FACTOR)
    file = file.strip()
    if not file:
        raise DemandError(f"orders are '{text}'; {kind}: has to name a file")
    return DayText(kind, file, factor, minutes)


def file_of(text: str) -> str:
    """Returns the file that an orders text names; "" if none. Raises DemandError."""
    if day := day_of(text):
        return day.file
    if text.startswith(f"{MIX}:"):
        text = text.removeprefix(f"{MIX}:").partition(":")[2]
    return text if text.endswith(".csv") else ""


def with_file(text: str, change: Callable[[str], str]) -> str:
    """Returns an orders text whose file, if it names one, is changed. Raises DemandError."""
    if day := day_of(text):
        return str(replace(day, file=change(day.file)))
    file = file_of(text)
    return text.removesuffix(file) + change(file) if file else text


def _number(text: str, number: str, most: float) -> float:
    try:
        value = float(number)
    except ValueError:
        value = 0.0
    if not 0 < value <= most:
        raise DemandError(
            f"orders are '{text}'; a number above 0, up to {most:g}, was expected in place of"
            f" '{number.strip()}'"
        )
    return value
