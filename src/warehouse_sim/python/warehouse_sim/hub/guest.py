# SPDX-License-Identifier: Apache-2.0
"""A warehouse that was launched elsewhere and shows itself in the hub while it runs."""

import time
from contextlib import suppress
from pathlib import Path
from urllib.parse import urlsplit

from warehouse_sim.hub.simulation import TIMEOUT, Simulation, State, orders_of
from warehouse_sim.hub.wish import Wish, WishError
from warehouse_viewer.server.hub_link import ask

PATIENCE = 10.0  # time without answers of its pages after which it leaves the list [s, wall]


class Guest(Simulation):
    """A simulation with pages at `viewer`, an address of this machine. The hub neither starts nor
    stops it."""

    def __init__(self, name: str, viewer: object) -> None:
        """Raises WishError for an address that is not one of this machine."""
        parts = urlsplit(viewer if isinstance(viewer, str) else "")
        local = parts.scheme == "http" and parts.hostname in ("localhost", "127.0.0.1")
        if not local or not parts.port or parts.path.strip("/"):
            raise WishError("address", "http://localhost:PORT was expected")
        super().__init__(Wish(name, arguments={"started": "elsewhere"}), Path())
        self.viewer = f"http://localhost:{parts.port}"
        self.state, self._begun = State.STARTING, time.monotonic()
        self._heard = time.monotonic()

    @property
    def is_gone(self) -> bool:
        """Whether its pages have not answered for PATIENCE."""
        return time.monotonic() - self._heard > PATIENCE

    def look(self, most_memory: int) -> None:
        """Updates its state; the hub does not limit its memory (`most_memory`)."""
        with suppress(OSError, ValueError, KeyError):
            self._warehouse = ask("GET", f"{self.viewer}/api/v1/warehouse", timeout=TIMEOUT)
            self.state = State.PAUSED if self._warehouse["paused"] else State.RUNNING
            self._heard = time.monotonic()
            self._orders = orders_of(self.viewer)
