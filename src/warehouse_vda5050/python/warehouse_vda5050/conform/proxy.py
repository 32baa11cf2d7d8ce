# SPDX-License-Identifier: Apache-2.0
"""A port that passes all bytes on to a broker, and can be cut: a radio that fails."""

import contextlib
import selectors
import socket
import struct
import threading

CHUNK = 65536
# Closes with a reset: the broker takes the vehicle as lost at once.
RESET = struct.pack("ii", 1, 0)


class Proxy:
    """Listens on a port of this machine for vehicles; port 0 takes any. Raises OSError."""

    def __init__(self, port: int, host: str, broker_port: int) -> None:
        self._broker = (host, broker_port)
        self._server = socket.create_server(("", port))
        self.port = self._server.getsockname()[1]
        self._selector = selectors.DefaultSelector()
        self._other: dict[socket.socket, socket.socket] = {}
        self._lock = threading.Lock()
        self._is_cut = self._closed = False
        self._selector.register(self._server, selectors.EVENT_READ)
        threading.Thread(target=self._run, daemon=True, name="conform-proxy").start()

    def cut(self) -> None:
        """Ends all connections without a word, and lets none in."""
        with self._lock:
            self._is_cut = True
            for end in [*self._other]:
                self._drop(end)

    def restore(self) -> None:
        """Lets vehicles in."""
        with self._lock:
            self._is_cut = False

    def close(self) -> None:
        """Ends it."""
        self.cut()
        self._closed = True

    def _run(self) -> None:
        while not self._closed:
            for key, _ in self._selector.select(0.05):
                with self._lock:
                    self._serve(key.fileobj)
        self._server.close()

    def _serve(self, end: object) -> None:
        if end is self._server:
            self._let_in()
        elif isinstance(end, socket.socket) and end in self._other:
            self._pass_on(end)

    def _let_in(self) -> None:
        vehicle, _ = self._server.accept()
        try:
            if self._is_cut:
                raise OSError("cut")
            broker = socket.create_connection(self._broker, 5.0)
        except OSError:
            vehicle.close()
            return
        for a, b in ((vehicle, broker), (broker, vehicle)):
            self._other[a] = b
            self._selector.register(a, selectors.EVENT_READ)

    def _pass_on(self, end: socket.socket) -> None:
        try:
            data = end.recv(CHUNK)
            if data:
                self._other[end].sendall(data)
                return
        except OSError:
            pass
        self._drop(end, orderly=True)

    def _drop(self, end: socket.socket, orderly: bool = False) -> None:
        other = self._other.get(end)
        for side in (end, other):
            if side is None or self._other.pop(side, None) is None:
                continue
            with contextlib.suppress(KeyError, ValueError):
                self._selector.unregister(side)
            if not orderly:
                side.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET)
            side.close()
