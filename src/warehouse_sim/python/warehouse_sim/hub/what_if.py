# SPDX-License-Identifier: Apache-2.0
"""The what-if page's requests, whose modules are loaded with the first of them."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING

from starlette.applications import Starlette
from starlette.types import ASGIApp, Receive, Scope, Send

if TYPE_CHECKING:
    from warehouse_viewer.whatif.workshop import Workshop


class WhatIf:
    """ASGI application: scenarios in a folder. Its modules take 40 MB and a second to load, and
    most hubs never need them."""

    def __init__(self, folder: Path) -> None:
        self._folder, self._lock = folder, asyncio.Lock()
        self._application: ASGIApp | None = None
        self._workshop: Workshop | None = None

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        async with self._lock:
            if self._application is None:
                self._application = await asyncio.to_thread(self._load)
            assert self._application is not None
        await self._application(scope, receive, send)

    def _load(self) -> ASGIApp:
        from warehouse_viewer.whatif.routes import routes
        from warehouse_viewer.whatif.workshop import Workshop

        self._workshop = Workshop(self._folder)
        return Starlette(routes=routes(self._workshop))

    def close(self) -> None:
        """Ends its runs."""
        if self._workshop:
            self._workshop.close()
