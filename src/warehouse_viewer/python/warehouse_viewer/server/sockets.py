# SPDX-License-Identifier: Apache-2.0
"""The WebSockets of a server, up to a limit."""

from collections.abc import Awaitable, Callable
from contextlib import suppress

from starlette.websockets import WebSocket, WebSocketState
from websockets.exceptions import ConnectionClosed

MOST_SOCKETS = 50
TRY_AGAIN = 1013  # a WebSocket's close code


class SocketLimit:
    """Accepts WebSockets while fewer than MOST_SOCKETS are open."""

    def __init__(self) -> None:
        self._open = 0

    async def admit(self, socket: WebSocket, serve: Callable[[WebSocket], Awaitable[None]]) -> None:
        """Accepts the socket and serves it to its end, or closes it with TRY_AGAIN."""
        await socket.accept()
        if self._open >= MOST_SOCKETS:
            await socket.close(TRY_AGAIN)
            return
        self._open += 1
        try:
            # uvicorn's sign of a client that went without a word: a machine that fell asleep.
            with suppress(ConnectionClosed):
                await serve(socket)
        finally:
            self._open -= 1
            # A client that has gone needs no close, and wsproto would refuse to send one.
            if socket.client_state is WebSocketState.CONNECTED:
                # TypeError: websockets' of a page that went before it had come.
                with suppress(RuntimeError, TypeError):
                    await socket.close()
