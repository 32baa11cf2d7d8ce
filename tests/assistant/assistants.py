# SPDX-License-Identifier: Apache-2.0
"""Clients by the SDK, as a digital assistant has them."""

import asyncio
import os
import sys
from contextlib import asynccontextmanager

import httpx2
from mcp import Client, StdioServerParameters
from mcp.client.streamable_http import streamable_http_client

TOKEN = {"authorization": "Bearer commands-token"}
MOST_REPLY = 2000  # [bytes]


class Assistant:
    """Calls tools; every reply is of bounded length and on printable lines."""

    def __init__(self, client):
        self.client = client

    async def call(self, tool, **arguments):
        """Returns (is_error, text)."""
        result = await self.client.call_tool(tool, arguments)
        text = "\n".join(part.text for part in result.content if part.type == "text")
        assert len(text.encode()) <= MOST_REPLY, f"{tool} {arguments}: {len(text.encode())} bytes"
        assert all(line.isprintable() for line in text.split("\n")), repr(text)
        return bool(result.is_error), text

    async def done(self, tool, **arguments):
        """Returns the text of a reply that is no error."""
        is_error, text = await self.call(tool, **arguments)
        assert not is_error, f"{tool} {arguments}: {text}"
        return text

    async def comes(self, words, tool, **arguments):
        """Asks until words stand in the reply: states come twice a second."""
        for _ in range(100):
            if words in (text := await self.done(tool, **arguments)):
                return
            await asyncio.sleep(0.2)
        raise AssertionError(f"{tool} {arguments}: {text}")

    async def refused(self, tool, **arguments):
        """Returns the text of a reply that is an error."""
        is_error, text = await self.call(tool, **arguments)
        assert is_error, f"{tool} {arguments}: {text}"
        return text


def command(hub, *options):
    """Returns how an assistant's program is started over stdio."""
    arguments = ["-m", "warehouse_assistant", "--hub", hub, *options]
    env = {"PYTHONPATH": os.environ["PYTHONPATH"]}
    return StdioServerParameters(command=sys.executable, args=arguments, env=env)


@asynccontextmanager
async def connected(hub, transport, commands):
    """Yields an Assistant that is connected to a hub."""
    if transport == "stdio":
        options = ["--allow", "commands"] if commands else []
        async with Client(command(hub, *options)) as client:
            yield Assistant(client)
        return
    headers = TOKEN if commands else {}
    async with (
        httpx2.AsyncClient(headers=headers, timeout=60, trust_env=False) as http,
        Client(streamable_http_client(f"{hub}/mcp", http_client=http)) as client,
    ):
        yield Assistant(client)
