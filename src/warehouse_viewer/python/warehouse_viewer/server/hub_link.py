# SPDX-License-Identifier: Apache-2.0
"""Shows a warehouse in a hub that serves at the port which the warehouse's own pages would have."""

import json
import re
import urllib.request
from contextlib import suppress

TIMEOUT = 2.0  # [s, wall]
API = "/api/v1/simulations"


def is_hub(port: int) -> bool:
    """Tells whether a hub serves at a port of this machine."""
    with suppress(OSError, ValueError, KeyError):
        return isinstance(_ask("GET", port, API)["simulations"], list)
    return False


def join(port: int, name: str, address: str) -> str:
    """Lists the warehouse at `address` in the hub at a port; returns its address there.

    Raises OSError where the hub refuses or does not answer.
    """
    wished = re.sub(r"[^a-z0-9-]+", "-", name.lower()).strip("-")[:40] or "warehouse"
    row = _ask("PUT", port, f"{API}/{wished}", {"address": address.rstrip("/")})
    return f"http://localhost:{port}{row['url']}"


def _ask(method: str, port: int, path: str, body: dict | None = None) -> dict:
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(f"http://localhost:{port}{path}", data, method=method)
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    with opener.open(request, timeout=TIMEOUT) as answer:
        return json.loads(answer.read())
