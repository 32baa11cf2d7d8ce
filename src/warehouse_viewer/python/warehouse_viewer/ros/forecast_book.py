# SPDX-License-Identifier: Apache-2.0
"""The forecasts of a shift that were asked for, with what came of them."""

import threading
from collections import OrderedDict

from warehouse_msgs.msg import ForecastResult

MOST_KEPT = 20


class ForecastBook:
    """The last results by number. Any thread may call."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._results: OrderedDict[int, ForecastResult] = OrderedDict()
        self._asked = 0
        self._plain: ForecastResult | None = None

    @property
    def plain(self) -> ForecastResult | None:
        """The newest result without changes; what only would be, or was not made, leaves it."""
        return self._plain

    @property
    def newest(self) -> int:
        """The number of the newest forecast, 0: none was asked for."""
        return max(self._asked, *self._results, 0)

    def ask(self, number: int) -> None:
        """Notes that a forecast was asked for; a shift that has begun again counts from 1."""
        with self._lock:
            if number <= self._asked:
                self._begin_again()
            self._asked = number

    def take(self, result: ForecastResult) -> None:
        """Keeps a result."""
        with self._lock:
            if result.forecast_id < max(self._results, default=0):
                self._begin_again()
            self._results[result.forecast_id] = result
            if result.runs and not result.changes:
                self._plain = result
            while len(self._results) > MOST_KEPT:
                self._results.popitem(last=False)

    def _begin_again(self) -> None:
        """Drops what was of another shift."""
        self._results.clear()
        self._asked, self._plain = 0, None

    def result(self, number: int) -> ForecastResult | None:
        """Returns the result of a forecast; None while it is computed, or if it is not kept."""
        return self._results.get(number)
