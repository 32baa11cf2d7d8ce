# SPDX-License-Identifier: Apache-2.0
"""A hub in a process of its own, for tests."""

import signal
import sys

import paths

sys.path.append(str(paths.ROOT / "tests" / "assistant"))

from served_hub import PATIENCE, ServedHub, until  # noqa: E402, F401 (for the tests)

from warehouse_sim.hub.process import descendants, marked  # noqa: E402


class Hub(ServedHub):
    def end(self, number=signal.SIGINT):
        """Ends the hub; returns the processes that it and they had started."""
        below = descendants(self.process.pid)
        super().end(number)
        if number == signal.SIGINT:
            assert not marked(self.home), "processes outlive the hub"
        return below
