# SPDX-License-Identifier: Apache-2.0
"""The documentation that `make docs` builds, served without internet."""

import re
from collections.abc import Sequence
from pathlib import Path

from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.routing import BaseRoute, Mount, Route
from starlette.types import Message, Receive, Scope, Send

from warehouse_viewer.server.csp import csp_source
from warehouse_viewer.server.static_files import FreshFiles
from warehouse_viewer.shared_files import SHARE

# The folders of an install space, of the package kiva-warehouse-doc, and of the source tree.
FOLDERS = (
    SHARE / "docs",
    Path("/usr/share/doc/kiva-warehouse-doc/html"),
    SHARE.parents[1] / "build" / "docs",
)
MISSING = """<!doctype html><html lang="en"><meta charset="utf-8">
<title>Documentation – Kiva warehouse</title>
<link rel="stylesheet" href="/web/design.css"><main><h1>Documentation</h1>
<p>It is not built yet. Run <code>make docs</code> in the source tree, then reload this page.</p>
<p><a href="/api/docs">The HTTP API</a> has a page of its own.</p></main></html>"""
INLINE = re.compile(r"<script>(.*?)</script>", re.S)


def routes(folders: Sequence[Path] = FOLDERS) -> list[BaseRoute]:
    """Returns the routes of /docs, which show the first of the folders that has an index.html."""
    return [Route("/docs", _to_folder), Mount("/docs", Documentation(folders))]


def is_built() -> bool:
    """Returns whether there is a documentation to be shown."""
    return _built(FOLDERS) is not None


def _built(folders: Sequence[Path]) -> Path | None:
    return next((folder for folder in folders if (folder / "index.html").is_file()), None)


async def _to_folder(_: Request) -> Response:
    return RedirectResponse("/docs/")


class Documentation:
    """ASGI application: files of the folder, which may be built while the server runs."""

    def __init__(self, folders: Sequence[Path]) -> None:
        self._folders = folders

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        folder = _built(self._folders)
        if folder is None:
            await HTMLResponse(MISSING, 404)(scope, receive, send)
            return
        policy = content_policy((folder / "index.html").read_text()).encode()

        async def headed(message: Message) -> None:
            if message["type"] == "http.response.start":
                own = (b"content-security-policy", policy)
                message = message | {"headers": [*message.get("headers", []), own]}
            await send(message)

        await FreshFiles(directory=folder, html=True)(scope, receive, headed)


def content_policy(page: str) -> str:
    """Returns the content security policy of pages that have the same inline scripts as `page`.

    Only these scripts run, by their hashes; styles may be inline, since the theme has its colours
    there.
    """
    scripts = " ".join(dict.fromkeys(csp_source(script) for script in INLINE.findall(page)))
    return (
        "default-src 'self'; img-src 'self' data:; style-src 'self' 'unsafe-inline'; "
        f"script-src 'self' {scripts}; frame-ancestors 'none'"
    )
