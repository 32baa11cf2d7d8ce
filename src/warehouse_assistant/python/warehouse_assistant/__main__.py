# SPDX-License-Identifier: Apache-2.0
"""Serves the Model Context Protocol over stdio, or with --port over streamable HTTP at /mcp.

python3 -m warehouse_assistant [--hub http://localhost:8080] [--allow commands] [--port PORT]

The environment variable WAREHOUSE_TOKEN is the hub's token, if it has one.
"""

import argparse
import os
from urllib.parse import urlsplit


def _settings() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="warehouse_assistant", description=(__doc__ or "").splitlines()[0]
    )
    parser.add_argument("--hub", default="http://localhost:8080", help="(http://localhost:8080)")
    parser.add_argument(
        "--allow", choices=["commands"], help="let tools change something; reading needs nothing"
    )
    parser.add_argument("--port", type=int, help="serve streamable HTTP there instead of stdio")
    out = parser.parse_args()
    parts = urlsplit(out.hub)
    if parts.scheme not in ("http", "https") or not parts.hostname:
        parser.error(f"--hub {out.hub}: an address as http://localhost:8080 was expected")
    if out.port is not None and not 1 <= out.port <= 65535:
        parser.error(f"--port {out.port}: 1 to 65535 was expected")
    return out


def main() -> None:
    """Serves until its client or the hub ends."""
    settings = _settings()
    # Imported here, so that --help answers where the packages of PyPI are not installed.
    from warehouse_assistant.hub_client import HubClient
    from warehouse_assistant.library import Library
    from warehouse_assistant.server import AssistantServer, serve_http

    hub = HubClient(settings.hub, os.environ.get("WAREHOUSE_TOKEN", ""))
    server = AssistantServer(hub, settings.allow == "commands", Library(hub))
    if settings.port is None:
        server.run("stdio")
    else:
        serve_http(server, settings.port, os.environ.get("WAREHOUSE_ASSISTANT_KEY", ""))


if __name__ == "__main__":
    main()
