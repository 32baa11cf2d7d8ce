# SPDX-License-Identifier: Apache-2.0
"""The warehouse's page for a world in this process: http://127.0.0.1:PORT, robots in 3D and all.

Who looks can pause, go on, step and choose a speed; what robots do is decided by the program.
"""

import sys

from kiva_plugin_cpp import EventKind
from warehouse_learning.live import LiveWorld
from warehouse_learning.pace import Pace

PORT = 8090  # the next free one if it is taken
SPEED = 5.0  # simulated seconds a wall second, until somebody chooses another
NEEDS = "the page needs starlette, uvicorn and wsproto: pip install 'kiva_warehouse[learning]'"


class Page:
    """Shows a kiva_plugin_cpp.World, which others step, until it is closed. ImportError without
    what it is served by, OSError without a free port."""

    def __init__(self, world, name="", port=PORT, speed=SPEED):
        try:
            from warehouse_learning.page_server import PageServer
            from warehouse_viewer.page.journal import Journal
        except ImportError as error:
            raise ImportError(f"{NEEDS} ({error})") from error
        self._world, self._pace, self._journal = world, Pace(speed), Journal()
        self._live = LiveWorld(world, self._pace)
        told = self._live, self._journal, self._pace
        self._server = PageServer(name, world.step_size, *told, port)
        self.url = self._server.url
        print(f"watch it: {self.url}", file=sys.stderr)

    @property
    def watchers(self):
        """How many look."""
        return self._server.hub.pages

    def show(self):
        """The world as it is now."""
        self._live.take()
        self._server.hub.news()

    def moved(self):
        """Shows it to those who look. Returns when its time may go on."""
        if self.watchers:
            self.show()
        self._pace.wait(self._world.time)

    def tell(self, events):
        """What happened: (time, kind, model, other, text, command) each, as of World.events()."""
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

    def close(self):
        """Ends it; whoever looks keeps what was shown last."""
        self._pace.end()
        self._server.close()
