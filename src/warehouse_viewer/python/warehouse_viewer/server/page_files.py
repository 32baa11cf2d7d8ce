# SPDX-License-Identifier: Apache-2.0
"""The page's own files over HTTP, and its WebSockets, of which there are only so many."""

from collections.abc import Awaitable, Callable
from contextlib import suppress
from pathlib import Path

from starlette.requests import Request
from starlette.responses import Response
from starlette.websockets import WebSocket, WebSocketState

from warehouse_viewer.server.static_files import FreshFiles

MOST_SOCKETS = 50
TRY_AGAIN = 1013  # a WebSocket's close code


class PageFiles:
    """The folder of the page; `files` is the application to mount below /web."""

    def __init__(self, folder: Path) -> None:
        self.files = FreshFiles(directory=folder)

    def endpoint(self, name: str) -> Callable[[Request], Awaitable[Response]]:
        """Returns an endpoint that answers with one of the files."""

        async def get(request: Request) -> Response:
            return await self.files.get_response(name, request.scope)

        return get


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
            await serve(socket)
        finally:
            self._open -= 1
            # A client that has gone needs no close, and wsproto would refuse to send one.
            if socket.client_state is WebSocketState.CONNECTED:
                # TypeError: websockets' of a page that went before it had come.
                with suppress(RuntimeError, TypeError):
                    await socket.close()
