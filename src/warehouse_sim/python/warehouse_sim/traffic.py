# SPDX-License-Identifier: Apache-2.0
"""Many robots that drive all the time: for benchmarks and tests of what follows them."""

import time
from types import ModuleType

from warehouse_client.engine import Engine
from warehouse_client.message_check import subscribe
from warehouse_layout.models import models
from warehouse_msgs.msg import Event, MoveAlong

PITCH = 3  # of the robots [m]; each needs the metre before it


def build(ros: ModuleType, robots: int) -> None:
    """Adds robots to an empty floor, on a square lattice around the origin. Raises EngineError."""
    side = int((robots - 1) ** 0.5) + 1
    cells = [
        ((i % side - side // 2) * PITCH, (i // side - side // 2) * PITCH) for i in range(robots)
    ]
    parts = [models.include("kiva", i, *cell) for i, cell in enumerate(cells, start=1)]
    with Engine(ros) as engine:
        engine.spawn(models.document(parts), parts[0].name)


class Traffic:
    """Keeps the robots 1 … n driving: a metre forth, a metre back. `ros` is rospy."""

    def __init__(self, ros: ModuleType, robots: int) -> None:
        self._way = dict.fromkeys(range(1, robots + 1), 1)
        self._topic = ros.Publisher("movx", MoveAlong, queue_size=0)
        subscribe(ros, "warehouse/events", Event, self._go_on, queue_size=100000)
        while not self._topic.get_num_connections():
            time.sleep(0.05)

    def start(self) -> None:
        """Sends every robot its first command."""
        for kiva in self._way:
            self._send(kiva)

    def _send(self, kiva: int) -> None:
        self._topic.publish(distance=self._way[kiva], kiva_id=kiva)
        self._way[kiva] = -self._way[kiva]

    def _go_on(self, event: Event) -> None:
        if event.kind == Event.DONE:
            self._send(models.kind_and_number(event.model)[1])
