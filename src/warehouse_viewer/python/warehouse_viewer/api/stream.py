# SPDX-License-Identifier: Apache-2.0
"""States and events in JSON over a WebSocket, for clients that want nothing binary.

    /api/v1/stream?rate=2        messages a second at most, 0.1 … 10

First comes every robot, then those that changed, and each event once:

    {"type": "robots", "time": 12.3, "robots": [{"name": "kiva1", "status": "BUSY", …}, …]}
    {"type": "events", "events": [{"id": 7, "kind": "DONE", "model": "kiva1", …}, …]}

A slow reader misses states in between, never the newest; of events at most the oldest.
"""

import asyncio
import json
from contextlib import suppress
from typing import Any

from fastapi import HTTPException
from starlette.websockets import WebSocket, WebSocketDisconnect

from warehouse_viewer.api.backend import ApiBackend
from warehouse_viewer.api.schemas.pydantic_versions import as_dict


async def serve(socket: WebSocket, backend: ApiBackend, rate: float) -> None:
    """Serves one client until it disconnects, at most `rate` times a second.

    The socket is accepted already.
    """
    listener = asyncio.create_task(until_gone(socket))
    known: dict[int, Any] = {}
    event = backend.journal.last_id
    with suppress(WebSocketDisconnect, RuntimeError):
        while not listener.done():
            known = await _send_robots(socket, backend, known)
            events = backend.journal.since(event)
            if events:
                event = events[-1]["id"]
                await _send(socket, {"type": "events", "events": events})
            await asyncio.wait({listener}, timeout=1 / rate)
    listener.cancel()


async def until_gone(socket: WebSocket) -> None:
    """Reads and drops what a client sends until it disconnects."""
    with suppress(WebSocketDisconnect, RuntimeError):
        while True:
            await socket.receive_text()


async def _send_robots(socket, backend, known):
    try:
        robots = {r.id: as_dict(r) for r in await backend.robots()}
    except HTTPException:  # the world does not answer now; it may come back
        return known
    news = [robot for number, robot in robots.items() if known.get(number) != robot]
    if news:
        time = backend.feed["fleet"].stamp.to_sec()
        await _send(socket, {"type": "robots", "time": time, "robots": news})
    return robots


async def _send(socket, message):
    await socket.send_text(json.dumps(message, separators=(",", ":")))
