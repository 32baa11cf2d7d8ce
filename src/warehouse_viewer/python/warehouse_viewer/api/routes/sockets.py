# SPDX-License-Identifier: Apache-2.0
"""The WebSockets: the page's, and those of the API."""

from fastapi import APIRouter, WebSocket

from warehouse_viewer.api import changes, stream

UNSUPPORTED = 1003  # a WebSocket's close code
MOST_REASON = 120  # characters beside one

router = APIRouter()


@router.websocket("/live")
async def live(socket: WebSocket) -> None:
    """Serves the page."""
    state = socket.app.state
    await state.sockets.admit(socket, state.hub.serve)


@router.websocket("/api/v1/stream")
async def json_stream(socket: WebSocket, rate: float = 2.0) -> None:
    """Serves robots and events; see api/stream.py."""
    state, rate = socket.app.state, _bounded(rate)
    await state.sockets.admit(socket, lambda s: stream.serve(s, state.backend, rate))


@router.websocket("/api/v1/changes")
async def json_changes(socket: WebSocket, of: str = "", rate: float = 2.0) -> None:
    """Serves what changes in orders, stock, stations and the like; see api/changes.py."""
    try:
        topics = changes.topics(of)
    except ValueError as error:
        await socket.accept()
        await socket.close(UNSUPPORTED, str(error)[:MOST_REASON])
        return
    state, rate = socket.app.state, _bounded(rate)
    await state.sockets.admit(socket, lambda s: changes.serve(s, state.backend, topics, rate))


def _bounded(rate: float) -> float:
    """Returns the rate that a client gets, in messages per second."""
    return min(10.0, max(0.1, rate)) if rate == rate else 2.0
