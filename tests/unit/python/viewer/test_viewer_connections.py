# SPDX-License-Identifier: Apache-2.0
"""Connections over TCP: quick answers, no end of patience, and only so many."""

import asyncio
import socket

import pytest
import uvicorn
from asgi import echo

from warehouse_viewer.server import connections
from warehouse_viewer.server.connections import BoundedConnection
from warehouse_viewer.server.http_server import config_of

PATIENCE = 20  # of this test with the server [s, wall]
GET = b"GET / HTTP/1.1\r\nhost: localhost\r\n\r\n"
BEGUN = b"POST / HTTP/1.1\r\nhost: localhost\r\ncontent-length: 5\r\n\r\n"


class Server(uvicorn.Server):
    def install_signal_handlers(self):
        """pytest's stay."""


def serving(visit, application=echo):
    """Runs visit(server, connect) with a server at its side."""

    async def run():
        listener = connections.listen("127.0.0.1", 0)
        server = Server(config_of(application))
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
