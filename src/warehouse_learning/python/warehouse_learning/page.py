# SPDX-License-Identifier: Apache-2.0
"""The warehouse's page for a world in this process: http://127.0.0.1:PORT, in 3D.

The page can pause, resume and step the world and set its speed; the program alone decides what
robots do.
"""

import sys
from collections.abc import Iterable

from kiva_plugin_cpp import EventKind, World

PORT = 8090  # the next free one if it is taken
SPEED = 5.0  # simulated seconds per wall second, until the page sets another
NEEDS = "the page needs its server: pip install 'kiva_warehouse[learning]'"

Event = tuple[float, int, str, str, str, int]


class Page:
    """Shows a World, which the program steps, until it is closed.

    `name` is the title, `port` the first one to try, `speed` the first target in simulated seconds
    per wall second (0: as fast as possible); `url` says where to look. Raises ImportError without
    the packages that serve it, OSError without a free port.
    """

    def __init__(
        self, world: World, name: str = "", port: int = PORT, speed: float = SPEED
    ) -> None:
        try:
            from warehouse_viewer.page import pace, world_source
            from warehouse_viewer.server.local_server import LocalServer
        except ImportError as error:
            raise ImportError(f"{NEEDS} ({error})") from error
        self._world, self._pace = world, pace.Pace(speed)
        source, self._feed = world_source.source_of(world, name, self._pace)
        self._journal = source.journal
        self._server = LocalServer(source, port)
        self.url = self._server.url
        print(f"watch it: {self.url}", file=sys.stderr)

    @property
    def watchers(self) -> int:
        """How many browsers have the page open."""
        return self._server.hub.pages

    def show(self) -> None:
        """Shows the world's present state."""
        self._feed.update()
        self._server.hub.notify()

    def requested(self, units: Iterable[int]) -> None:
        """Marks the storage units of these numbers, and no others, as requested."""
        self._feed.request(int(unit) for unit in units)

    def moved(self) -> None:
        """Shows the world if a browser has the page open, and waits until time may advance."""
        if self.watchers:
            self.show()
        self._pace.wait(self._world.time)

    def show_events(self, events: Iterable[Event]) -> None:
        """Adds events to the page's log: (time [s], kind, model, other, text, command) each, as
        World.events() returns them."""
        for time, kind, model, other, text, command in events:
            self._journal.add(
                {
                    "time": round(time, 3),
                    "kind": EventKind(kind).name,
                    "command": int(command),
                    "model": model,
                    "other": other,
                    "text": text,
                }
            )

    def close(self) -> None:
        """Ends the page; open browsers keep what was shown last."""
        self._pace.end()
        self._server.close()
