# SPDX-License-Identifier: Apache-2.0
"""Shows a warehouse in a hub that serves at the port which the warehouse's own pages would have."""

import json
import re
import urllib.request
from contextlib import suppress
from typing import Any

TIMEOUT = 2.0  # [s, wall]
API = "/api/v1/simulations"


def is_hub(port: int) -> bool:
    """Returns whether a hub serves at a port of this machine."""
    with suppress(OSError, ValueError, KeyError):
        return isinstance(ask("GET", f"http://localhost:{port}{API}")["simulations"], list)
    return False


def join(port: int, name: str, address: str) -> str:
    """Lists the warehouse at `address` in the hub at a port; returns its address there.

    Raises OSError where the hub refuses or does not answer.
    """
    wished = re.sub(r"[^a-z0-9-]+", "-", name.lower()).strip("-")[:40] or "warehouse"
    hub = f"http://localhost:{port}"
    row = ask("PUT", f"{hub}{API}/{wished}", {"address": address.rstrip("/")})
    return hub + row["url"]


def ask(method: str, url: str, body: dict | None = None, timeout: float = TIMEOUT) -> dict:
    """Returns the JSON that a server of this machine answers. Raises OSError, ValueError."""
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(url, data, method=method)
    with open_here(request, timeout) as answer:
        return json.loads(answer.read())


def open_here(request: urllib.request.Request | str, timeout: float) -> Any:
    """Returns the answer of a server of this machine, which no proxy leads to. Raises OSError."""
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    return opener.open(request, timeout=timeout)
