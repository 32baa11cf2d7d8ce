# SPDX-License-Identifier: Apache-2.0
"""Policies that say how many waiting bundles are worth the trip of a unit."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View


class Together:
    """Waits for `most` bundles that fit on one unit while the stock is above `stop`, a share of its
    room; for fewer as it falls, and for none below `begin`.

    fills: a visit takes along all bundles that have a place on its unit, also those that come while
    it lasts. Raises ValueError for fewer than one bundle, and unless 0 <= begin < stop <= 1.
    """

    def __init__(self, most: int = 8, begin: float = 0.65, stop: float = 0.85) -> None:
        if most < 1:
            raise ValueError(f"most is {most}; 1 or more was expected")
        if not 0 <= begin < stop <= 1:
            raise ValueError(f"begin {begin} and stop {stop}; 0 <= begin < stop <= 1 was expected")
        self.most, self.begin, self.stop = most, begin, stop
        self.fills = True

    def least(self, view: "View") -> int:
        """Returns the fewest bundles with which a unit is fetched now."""
        share = (view.inventory.level - self.begin) / (self.stop - self.begin)
        return 1 + round((self.most - 1) * min(max(share, 0.0), 1.0))


class AtOnce:
    """Fetches a unit for any bundle.

    fills: one that takes as many of the waiting bundles as any, and a visit takes along all that
    have a place on its unit, also those that come while it lasts. Raises ValueError unless it is
    true or false.
    """

    def __init__(self, fills: bool = False) -> None:
        if not isinstance(fills, bool):
            raise ValueError(f"fills is {fills!r}; true or false was expected")
        self.fills = fills

    def least(self, view: "View") -> int:
        """Returns 1."""
        return 1


NAMES: dict[str, type] = {"together": Together, "at once": AtOnce}
