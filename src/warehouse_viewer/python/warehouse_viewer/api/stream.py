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

from fastapi import HTTPException
from starlette.websockets import WebSocketDisconnect


async def serve(socket, desk, rate):
    """One client, from its coming to its going. `socket` was accepted; `desk` is api.ApiBackend."""
    listener = asyncio.create_task(until_gone(socket))
    known, event = {}, desk.journal.last_id
    with suppress(WebSocketDisconnect, RuntimeError):
        while not listener.done():
            known = await _send_robots(socket, desk, known)
            events = desk.journal.since(event)
            if events:
                event = events[-1]["id"]
                await _send(socket, {"type": "events", "events": events})
            await asyncio.wait({listener}, timeout=1 / rate)
    listener.cancel()


async def until_gone(socket):
    """Reads, and forgets, what a client says until it goes."""
    with suppress(WebSocketDisconnect, RuntimeError):
        while True:
            await socket.receive_text()


async def _send_robots(socket, desk, known):
    try:
        robots = {r.id: r.dict() for r in await desk.robots()}
    except HTTPException:  # the world is away; it may come back
        return known
    news = [robot for number, robot in robots.items() if known.get(number) != robot]
    if news:
        time = desk.feed["fleet"].stamp.to_sec()
        await _send(socket, {"type": "robots", "time": time, "robots": news})
    return robots


async def _send(socket, message):
    await socket.send_text(json.dumps(message, separators=(",", ":")))
