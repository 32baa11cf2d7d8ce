# SPDX-License-Identifier: Apache-2.0
"""Connections over TCP: quick answers, no end of patience, and only so many."""

import asyncio
import socket

import pytest
import uvicorn
from asgi import echo
from starlette.applications import Starlette
from starlette.routing import WebSocketRoute

from warehouse_viewer.api import stream
from warehouse_viewer.server import connections
from warehouse_viewer.server.connections import BoundedConnection
from warehouse_viewer.server.http_server import config_of
from warehouse_viewer.server.sockets import SocketLimit

PATIENCE = 20  # of this test with the server [s, wall]
GET = b"GET / HTTP/1.1\r\nhost: localhost\r\n\r\n"
UPGRADE = GET[:-2] + (
    b"connection: upgrade\r\nupgrade: websocket\r\nsec-websocket-version: 13\r\n"
    b"sec-websocket-key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
)
GIVEN_UP = (1011).to_bytes(2, "big")  # a WebSocket's close code
BEGUN = b"POST / HTTP/1.1\r\nhost: localhost\r\ncontent-length: 5\r\n\r\n"


class Server(uvicorn.Server):
    def install_signal_handlers(self):
        """pytest's stay."""


def serving(visit, application=echo, **options):
    """Runs visit(server, connect) with a server at its side; `options` are uvicorn's."""

    async def run():
        listener = connections.listen("127.0.0.1", 0)
        server = Server(config_of(application, **options))
        task = asyncio.create_task(server.serve(sockets=[listener]))
        port = listener.getsockname()[1]
        try:
            await visit(server, lambda: asyncio.open_connection("127.0.0.1", port))
        finally:
            server.should_exit = server.force_exit = True
            await task

    asyncio.run(asyncio.wait_for(run(), 3 * PATIENCE))


async def ask(streams, request=GET):
    reader, writer = streams
    writer.write(request)
    head = await reader.readuntil(b"0\r\n\r\n")  # and the end of a body of no chunks
    return head.split(b"\r\n")[0]


async def end(streams):
    """What still comes until the server ends the connection."""
    try:
        return await asyncio.wait_for(streams[0].read(), PATIENCE)
    except ConnectionResetError:
        return b""


def test_small_answers_do_not_wait_for_the_client():
    async def visit(server, connect):
        await ask(await connect())
        (connection,) = server.server_state.connections
        accepted = connection.transport.get_extra_info("socket")
        assert accepted.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)

    serving(visit)


@pytest.mark.parametrize("said", [b"", b"GET / HT", BEGUN, BEGUN + b"abc", GET + b"GET"])
def test_who_does_not_ask_is_shown_out(monkeypatch, said):
    monkeypatch.setattr(BoundedConnection, "PATIENCE", 0.3)

    async def visit(_, connect):
        streams = await connect()
        streams[1].write(said)
        await end(streams)

    serving(visit)


def test_who_is_being_served_is_not(monkeypatch):
    monkeypatch.setattr(BoundedConnection, "PATIENCE", 0.1)

    async def slow(scope, receive, send):
        await asyncio.sleep(1)
        await echo(scope, receive, send)

    async def visit(_, connect):
        assert await ask(await connect()) == b"HTTP/1.1 200 OK"

    serving(visit, slow)


def test_a_newcomer_ends_the_one_that_waited_longest(monkeypatch):
    monkeypatch.setattr(BoundedConnection, "MOST", 3)

    async def visit(server, connect):
        first = await connect()
        await ask(first)
        others = [await connect() for _ in range(2)]
        for streams in others:
            await ask(streams)
        newest = await connect()
        assert await ask(newest) == b"HTTP/1.1 200 OK"
        assert await end(first) == b""
        for streams in others:
            assert await ask(streams) == b"HTTP/1.1 200 OK"
        assert len(server.server_state.connections) == 3

    serving(visit)


def test_a_machine_that_fell_asleep_is_no_error(caplog):
    """It answers no pings, and what is sent to it then goes nowhere."""
    sockets, gone = SocketLimit(), asyncio.Event()

    async def tell(socket):
        try:
            while True:
                await socket.send_text("news")
                await asyncio.sleep(0.01)
        finally:
            gone.set()

    async def visit(_, connect):
        reader, writer = await connect()
        writer.write(UPGRADE)
        assert b"101" in await reader.readline()
        await reader.readuntil(GIVEN_UP)
        writer.close()
        await asyncio.wait_for(gone.wait(), PATIENCE)

    application = Starlette(routes=[WebSocketRoute("/", lambda s: sockets.admit(s, tell))])
    serving(visit, application, ws="websockets", ws_ping_interval=0.1, ws_ping_timeout=0.1)
    assert "Exception" not in caplog.text


def followed(send_news, ended):
    """An application that sends news over a WebSocket, and puts the end into `ended`."""

    async def follow(socket):
        await socket.accept()
        try:
            await stream.until_gone(socket, lambda: send_news(socket), rate=10)
            ended.put_nowait(None)
        except Exception as error:
            ended.put_nowait(error)

    return Starlette(routes=[WebSocketRoute("/", follow)])


@pytest.mark.parametrize("library", ["websockets", "wsproto"])
def test_a_client_that_goes_while_it_is_sent_to_is_no_fault(library):
    pytest.importorskip(library)
    ended = asyncio.Queue()

    async def flood(socket):
        while True:  # it reads none of it
            await socket.send_text("x" * 60_000)
            await asyncio.sleep(0)

    async def visit(_, connect):
        reader, writer = await connect()
        writer.write(UPGRADE)
        await reader.readuntil(b"x" * 1000)
        writer.transport.abort()
        assert await asyncio.wait_for(ended.get(), PATIENCE) is None

    serving(visit, followed(flood, ended), ws=library)


def test_a_fault_while_the_client_is_there_is_one(monkeypatch):
    monkeypatch.setattr(stream, "FAREWELL", 0.1)
    ended = asyncio.Queue()

    async def fail(_):
        raise KeyError("robots")

    async def visit(_, connect):
        _, writer = await connect()
        writer.write(UPGRADE)
        assert isinstance(await asyncio.wait_for(ended.get(), PATIENCE), KeyError)

    serving(visit, followed(fail, ended))
