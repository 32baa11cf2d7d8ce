# SPDX-License-Identifier: Apache-2.0
"""Options that several programs have, and the values that argparse accepts for them.

Each reader returns the value of a text, or raises argparse.ArgumentTypeError with what was
expected.
"""

import argparse
import math
from collections.abc import Callable

MOST_WHOLE = 1_000_000


def number(most: float, least: float = 0.0) -> Callable[[str], float]:
    """Returns a reader of numbers above 0, from `least` to `most`."""

    def read(text: str) -> float:
        value = _float(text)
        if not least <= value <= most or not value:
            low = f"{least:g} or more" if least else "above 0"
            raise argparse.ArgumentTypeError(
                f"{text}; a number {low}, up to {most:g}, was expected"
            )
        return value

    return read


def whole(text: str) -> int:
    """Reads a whole number above 0."""
    if not text.isdecimal() or not 0 < int(text) <= MOST_WHOLE:
        raise argparse.ArgumentTypeError(f"{text}; a whole number above 0 was expected")
    return int(text)


def share(text: str) -> float:
    """Reads a share between 0 and 1: "0.01" or "1%"."""
    value = _float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    if not 0 < value < 1:
        raise argparse.ArgumentTypeError(f"{text}; above 0 and below 100% was expected")
    return value


def add_executor(parser: argparse.ArgumentParser) -> None:
    """Adds where shifts run: --processes, --ray."""
    parser.add_argument("--processes", type=whole, help="shifts at once (the number of cores)")
    parser.add_argument(
        "--ray",
        metavar="ADDRESS",
        nargs="?",
        const="local",
        help="run on a Ray cluster instead; without ADDRESS on a local one",
    )


def _float(text: str) -> float:
    """Returns the number that a text holds, NaN for another text: no range contains it."""
    try:
        return float(text)
    except ValueError:
        return math.nan
