# SPDX-License-Identifier: Apache-2.0
"""HTTP connections up to a limit, which end where they ask nothing.

uvicorn bounds how long a connection may idle between two requests, but not how long the first, or
the rest of one that was begun, may take to come; nor how many connections there are.
"""

import asyncio
import socket

from uvicorn.protocols.http.h11_impl import H11Protocol


class BoundedConnection(H11Protocol):
    """One of at most MOST; where they are taken, a newcomer ends the one that waited longest."""

    MOST = 200  # WebSockets included; each costs a file
    PATIENCE = 15.0  # with a request that does not come, or not wholly [s, wall]

    def connection_made(self, transport: asyncio.Transport) -> None:
        """Starts to wait for a request (asyncio's hook)."""
        super().connection_made(transport)
        self._since = self.loop.time()  # it waits for a request
        if len(self.connections) > self.MOST:
            self._make_room()
        self._look_later(self.PATIENCE)

    def on_response_complete(self) -> None:
        """Starts to wait for the next request (uvicorn's hook)."""
        self._since = self.loop.time()
        super().on_response_complete()

    def _waits(self) -> bool:
        """Whether it waits for its client to ask, or to go on with its request."""
        return self.cycle is None or self.cycle.response_complete or self.cycle.more_body

    def _make_room(self) -> None:
        ours = (c for c in self.connections if isinstance(c, BoundedConnection))
        waiting = [c for c in ours if c is not self and c._waits()]
        min(waiting, key=lambda c: c._since, default=self).transport.abort()

    def _look_later(self, delay: float) -> None:
        self._timer = self.loop.call_later(delay, self._look)

    def _look(self) -> None:
        if self.transport.is_closing() or self.transport.get_protocol() is not self:
            return  # it ended, or became a WebSocket
        left = self._since + self.PATIENCE - self.loop.time() if self._waits() else self.PATIENCE
        if left > 0:
            self._look_later(left)
        else:
            self.transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stops waiting (asyncio's hook)."""
        self._timer.cancel()
        super().connection_lost(exc)


def listen_near(host: str, port: int, tries: int = 20) -> socket.socket:
    """Returns a socket that listens at `port` or one of the next, at any free one for port 0.

    Raises OSError if all are taken.
    """
    for k in range(tries):
        try:
            return listen(host, port + k if port else 0)
        except OSError as error:
            last = error
    raise OSError(f"no port from {port} to {port + tries - 1} is free for the page: {last}")


def listen(host: str, port: int) -> socket.socket:
    """Returns a socket that listens there.

    Raises OSError if the port is taken or the host is not this machine's.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # asyncio does not recognise a TCP socket that doesn't name its protocol; small answers
    # would then wait 40 ms for the client's acknowledgement (Nagle, 1984).
    out = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        out.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        out.bind((host, port))
        out.listen(128)
    except OSError:
        out.close()
        raise
    return out
