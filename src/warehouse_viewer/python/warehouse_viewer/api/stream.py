# SPDX-License-Identifier: Apache-2.0
"""States and events in JSON over a WebSocket, for clients that want nothing binary.

    /api/v1/stream?rate=2        messages a second at most, 0.1 … 10

First comes every robot, then those that changed, and each event once:

    {"type": "robots", "time": 12.3, "robots": [{"name": "kiva1", "status": "BUSY", …}, …]}
    {"type": "events", "events": [{"id": 7, "kind": "DONE", "model": "kiva1", …}, …]}

A slow reader misses states in between, never the newest; of events at most the oldest.
"""

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from typing import Any

from fastapi import HTTPException
from starlette.websockets import WebSocket, WebSocketDisconnect

from warehouse_viewer.api.backend import ApiBackend
from warehouse_viewer.api.schemas.pydantic_versions import as_dict
from warehouse_viewer.json_text import dumps

FAREWELL = 1.0  # until a client that nothing can be sent to is known to have gone [s, wall]


async def serve(socket: WebSocket, backend: ApiBackend, rate: float) -> None:
    """Serves one client until it disconnects, at most `rate` times a second.

    The socket is accepted already.
    """
    known: dict[int, Any] = {}
    event = backend.journal.last_id

    async def send_news() -> None:
        nonlocal known, event
        known = await _send_robots(socket, backend, known)
        events = backend.journal.since(event)
        if events:
            event = events[-1]["id"]
            await _send(socket, {"type": "events", "events": events})

    await until_gone(socket, send_news, rate)


async def until_gone(
    socket: WebSocket, send_news: Callable[[], Awaitable[None]], rate: float
) -> None:
    """Sends news at most `rate` times a second until the client disconnects.

    Raises what send_news() raises while the client is there.
    """
    listener = asyncio.create_task(_listen(socket))
    sender = asyncio.create_task(_send_forever(send_news, 1 / rate))
    try:
        await asyncio.wait({listener, sender}, return_when=asyncio.FIRST_COMPLETED)
        # Each of uvicorn's libraries raises another error for a client that has gone.
        await asyncio.wait({listener}, timeout=FAREWELL)
        if not listener.done():
            sender.result()
    finally:
        listener.cancel()
        sender.cancel()
        await asyncio.gather(listener, sender, return_exceptions=True)


async def _send_forever(send_news: Callable[[], Awaitable[None]], gap: float) -> None:
    while True:
        await send_news()
        await asyncio.sleep(gap)


async def _listen(socket: WebSocket) -> None:
    """Reads and drops what a client sends until it disconnects."""
    with suppress(WebSocketDisconnect, RuntimeError):
        while True:
            await socket.receive_text()


async def _send_robots(
    socket: WebSocket, backend: ApiBackend, known: dict[int, Any]
) -> dict[int, Any]:
    try:
        robots = {r.id: as_dict(r) for r in await backend.robots()}
    except HTTPException:  # the world does not answer now; it may come back
        return known
    news = [robot for number, robot in robots.items() if known.get(number) != robot]
    if news:
        time = backend.feed["fleet"].stamp.to_sec()
        await _send(socket, {"type": "robots", "time": time, "robots": news})
    return robots


async def _send(socket: WebSocket, message: Mapping[str, Any]) -> None:
    await socket.send_text(dumps(message))
