# SPDX-License-Identifier: Apache-2.0
"""Passes HTTP requests and WebSockets on to a server of this machine."""

import asyncio
from collections.abc import AsyncIterator, Iterable
from contextlib import suppress
from typing import Any
from urllib.parse import urlsplit

import h11
from starlette.types import Receive, Scope, Send
from websockets import connect  # type: ignore[attr-defined]
from websockets.exceptions import ConnectionClosed, InvalidHandshake

from warehouse_viewer.json_text import JSONResponse

PIECE = 64 * 1024  # of a body [bytes]
PATIENCE = 15.0  # to connect; a server that is gone refuses at once [s, wall]
GONE = 1012  # close code of a WebSocket whose server went (RFC 6455's registry: service restart)
MOST_MESSAGE = 64 << 20  # from a simulation [bytes]
# Headers of one connection (RFC 9110, section 7.6.1), and headers for this server alone: it has
# checked names, origins and tokens.
HOP = frozenset(
    b"connection keep-alive proxy-connection te trailer transfer-encoding upgrade host origin"
    b" authorization cookie referer".split()
)

Headers = list[tuple[bytes, bytes]]


class Proxy:
    """ASGI application: passes requests on to the server at `target` (http://HOST:PORT).

    `prefix` is the path of that server here; redirects get it.
    """

    def __init__(self, target: str, prefix: str) -> None:
        parts = urlsplit(target)
        self._host, self._port = parts.hostname or "", parts.port or 80
        self._prefix = prefix

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "websocket":
            await self._pass_socket(scope, receive, send)
            return
        try:
            connecting = asyncio.open_connection(self._host, self._port)
            reader, writer = await asyncio.wait_for(connecting, PATIENCE)
        except (TimeoutError, OSError):
            answer = JSONResponse({"detail": "the simulation does not answer; try again"}, 503)
            await answer(scope, receive, send)
            return
        exchange = _Exchange(reader, writer)
        try:
            await self._pass_request(exchange, scope, receive, send)
        finally:
            writer.close()

    def _path(self, scope: Scope) -> str:
        raw = scope.get("raw_path") or scope["path"]
        text = raw.decode("latin-1") if isinstance(raw, bytes) else raw  # a text of WebSockets
        path = text.partition("?")[0].removeprefix(self._prefix) or "/"
        query = scope["query_string"].decode("latin-1")
        return f"{path}?{query}" if query else path

    async def _pass_request(
        self, exchange: "_Exchange", scope: Scope, receive: Receive, send: Send
    ) -> None:
        headers = [(k, v) for k, v in scope["headers"] if k not in HOP]
        headers += [(b"host", f"localhost:{self._port}".encode()), (b"connection", b"close")]
        has_length = any(name == b"content-length" for name, _ in headers)
        if not has_length and scope["method"] not in ("GET", "HEAD", "OPTIONS", "DELETE"):
            headers.append((b"transfer-encoding", b"chunked"))
        try:
            request = h11.Request(method=scope["method"], target=self._path(scope), headers=headers)
            await exchange.send(request)
            sending = asyncio.create_task(_send_body(exchange, receive))
            try:
                await self._pass_answer(exchange, send)
            finally:
                sending.cancel()
        except (h11.ProtocolError, OSError):
            # No other status can follow once the answer has begun.
            with suppress(RuntimeError):
                answer = JSONResponse({"detail": "the simulation broke the connection"}, 502)
                await answer(scope, receive, send)

    async def _pass_answer(self, exchange: "_Exchange", send: Send) -> None:
        async for event in exchange.events():
            if isinstance(event, h11.Response):
                headers = [*self._answered(event.headers)]
                start = {"type": "http.response.start", "status": event.status_code}
                await send({**start, "headers": headers})
            elif isinstance(event, h11.Data):
                body = {"type": "http.response.body", "body": bytes(event.data)}
                await send({**body, "more_body": True})
        await send({"type": "http.response.body", "body": b""})

    def _answered(self, headers: Iterable[tuple[bytes, bytes]]) -> Headers:
        out = [(name, value) for name, value in headers if name not in HOP]
        prefix = self._prefix.encode()
        return [(k, prefix + v if k == b"location" and v[:1] == b"/" else v) for k, v in out]

    async def _pass_socket(self, scope: Scope, receive: Receive, send: Send) -> None:
        await receive()  # websocket.connect
        url = f"ws://{self._host}:{self._port}{self._path(scope)}"
        options: dict[str, Any] = {"max_size": MOST_MESSAGE, "compression": None}
        try:
            async with connect(url, open_timeout=PATIENCE, **options) as server:
                await send({"type": "websocket.accept"})
                await _join(server, receive, send)
        except (TimeoutError, OSError, InvalidHandshake):
            with suppress(RuntimeError):
                await send({"type": "websocket.close", "code": GONE})


class _Exchange:
    """One request and its answer over a connection."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer
        self._state = h11.Connection(h11.CLIENT)

    async def send(self, event: h11.Event) -> None:
        data = self._state.send(event)
        if data:
            self._writer.write(data)
            await self._writer.drain()

    async def events(self) -> AsyncIterator[Any]:
        """Yields the events of the answer to its end. Raises h11.ProtocolError."""
        while True:
            event = self._state.next_event()
            if event is h11.NEED_DATA:
                self._state.receive_data(await self._reader.read(PIECE))
            elif isinstance(event, h11.EndOfMessage) or event is h11.PAUSED:
                return
            else:
                yield event


async def _send_body(exchange: _Exchange, receive: Receive) -> None:
    """Sends the request's body, and ends the connection when its client goes."""
    more = True
    while more:
        message = await receive()
        if message["type"] == "http.disconnect":
            exchange._writer.close()
            return
        if message.get("body"):
            await exchange.send(h11.Data(data=message["body"]))
        more = message.get("more_body", False)
    await exchange.send(h11.EndOfMessage())
    while (await receive())["type"] != "http.disconnect":
        pass
    exchange._writer.close()


async def _join(server: Any, receive: Receive, send: Send) -> None:
    """Passes messages between a client and a server until one of them goes."""

    async def to_server() -> None:
        while (message := await receive())["type"] == "websocket.receive":
            text = message.get("text")
            await server.send(message.get("bytes", b"") if text is None else text)

    async def to_client() -> None:
        async for message in server:
            key = "text" if isinstance(message, str) else "bytes"
            await send({"type": "websocket.send", key: message})
        code = server.close_code or GONE
        await send({"type": "websocket.close", "code": GONE if code == 1006 else code})

    tasks = [asyncio.create_task(to_server()), asyncio.create_task(to_client())]
    with suppress(ConnectionClosed, RuntimeError):
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    for task in tasks:
        task.cancel()
    with suppress(ConnectionClosed, RuntimeError, asyncio.CancelledError):
        await asyncio.gather(*tasks, return_exceptions=True)
