# SPDX-License-Identifier: Apache-2.0
"""Calls an ASGI application without a server."""

import asyncio
from dataclasses import dataclass


@dataclass
class Answer:
    status: int
    headers: dict
    body: bytes


async def _request(app, path, query="", method="GET", headers=(), body=(b"",), client="1.2.3.4"):
    parts, sent = list(body), []
    scope = {
        "type": "http",
        "method": method,
        "path": path,
        "query_string": query.encode(),
        "headers": [(k.encode(), v.encode()) for k, v in dict(headers).items()],
        "client": (client, 5),
    }

    async def receive():
        return {"type": "http.request", "body": parts.pop(0), "more_body": bool(parts)}

    async def send(message):
        sent.append(message)

    await app(scope, receive, send)
    start = sent[0]
    out = {k.decode(): v.decode() for k, v in start["headers"]}
    return Answer(start["status"], out, b"".join(m.get("body", b"") for m in sent[1:]))


def request(*args, **options):
    """The Answer to one HTTP request."""
    return asyncio.run(_request(*args, **options))


async def echo(scope, receive, send):
    """An application that gives the body back."""
    body, more = b"", True
    while more:
        message = await receive()
        if message["type"] == "http.disconnect":
            status = 400
            break
        body, more, status = body + message["body"], message["more_body"], 200
    await send({"type": "http.response.start", "status": status, "headers": []})
    await send({"type": "http.response.body", "body": body})
