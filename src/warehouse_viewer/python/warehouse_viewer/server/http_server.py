# SPDX-License-Identifier: Apache-2.0
"""The uvicorn server in which an application with a page runs."""

from __future__ import annotations

import asyncio
import os
import socket
import threading
from collections.abc import Callable, Sequence
from types import FrameType
from typing import TYPE_CHECKING, Any

import uvicorn
from starlette.types import ASGIApp

from warehouse_viewer.server.connections import BoundedConnection

if TYPE_CHECKING:
    from warehouse_viewer.page.hub import Hub

MOST_MESSAGE = 64 * 1024  # from a page [bytes]
STOP_PATIENCE = 1.0  # for a service call to a world that may be gone already [s, wall]


class Server(uvicorn.Server):
    """Stops at once on a signal: pages reconnect by themselves.

    As soon as it serves, it calls `on_start` in its asyncio loop and sets `is_serving`.
    """

    def __init__(self, config: uvicorn.Config, on_start: Callable[[], None]) -> None:
        super().__init__(config)
        self._on_start, self.is_serving = on_start, threading.Event()

    async def startup(self, sockets: Sequence[socket.socket] | None = None) -> None:
        """Starts to serve (uvicorn's hook)."""
        await super().startup(sockets)
        self._on_start()
        self.is_serving.set()

    def stop(self) -> None:
        """Ends the server without waiting for its clients. Any thread may call."""
        self.should_exit = self.force_exit = True

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Ends the process, even if a thread still waits for an answer (uvicorn's hook)."""
        self.stop()
        end = threading.Timer(STOP_PATIENCE, os._exit, (0,))
        end.daemon = True
        end.start()


class HubTask:
    """Runs a hub in the asyncio loop of the server that calls start()."""

    def __init__(self, hub: Hub) -> None:
        self._hub = hub
        self._task: asyncio.Task | None = None

    def start(self) -> None:
        """Starts the hub in the running loop."""
        self._task = asyncio.create_task(self._hub.run())  # kept: a loop holds tasks only weakly


def config_of(application: ASGIApp, **other: Any) -> uvicorn.Config:
    """Returns the server's configuration; `other` are further options of uvicorn.Config."""
    return uvicorn.Config(
        application,
        http=BoundedConnection,
        lifespan="off",
        log_level="warning",
        access_log=False,
        server_header=False,
        proxy_headers=False,
        ws_max_size=MOST_MESSAGE,
        # Numbers hardly shrink, and it would cost more than all else here.
        ws_per_message_deflate=False,
        **other,
    )
